// Objects of a scene by chance, and edits of their list. Header only.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "scene/objects.hpp"
#include "scene/shapes.hpp"

namespace conebook {

// Edits one after the other, with numbers of all sizes.
class RandomEdits {
public:
    explicit RandomEdits(unsigned seed) : random_(seed) {}
    double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }
    glm::dvec3 vector(double low, double high) { return {number(low, high), number(low, high), number(low, high)}; }

    ObjectMaterial material()
    {
        ObjectMaterial material;
        material.color = glm::vec3(vector(0.0, 1.0));
        material.metallic = float(below(2));
        material.roughness = float(number(0.0, 1.0));
        material.specular = float(number(0.0, 1.0));
        if (below(3) == 0) material.emission = glm::vec3(vector(0.0, 1.0) * std::pow(10.0, number(-6.0, 4.0)));
        return material;
    }
    Object object(const std::vector<std::string>& files)
    {
        Object object;
        const bool is_file = !files.empty() && below(2) == 0;
        object.source = is_file ? files[below(files.size())] : shape_names()[below(shape_names().size())];
        object.at = vector(-1.0, 1.0) * std::pow(10.0, number(-8.0, 1.0));
        if (below(2) == 0) object.turn_degrees = vector(-180.0, 180.0);
        object.scale = below(2) == 0 ? glm::dvec3(number(0.1, 1.0)) : vector(0.01, 2.0);
        if (below(2) == 0) object.material = material();
        object.dynamic = below(2) == 0;
        return object;
    }
    void edit(std::vector<Object>& objects, const std::vector<std::string>& files)
    {
        const std::size_t what = below(8);
        if (objects.empty() || (what == 0 && objects.size() < 6)) {
            objects.insert(objects.begin() + std::ptrdiff_t(below(objects.size() + 1)), object(files));
            return;
        }
        Object& one = objects[below(objects.size())];
        if (what == 1)
            objects.erase(objects.begin() + std::ptrdiff_t(below(objects.size())));
        else if (what == 2)
            one.dynamic = !one.dynamic;
        else if (what == 3)
            one.material = material();
        else if (what == 4)
            one.material.reset();
        else if (what == 5)
            one.turn_degrees = vector(-180.0, 180.0);
        else
            one.at += vector(-0.3, 0.3);
    }

private:
    std::mt19937 random_;
};

}  // namespace conebook
