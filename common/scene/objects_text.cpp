#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "scene/objects.hpp"
#include "scene/shapes.hpp"

namespace conebook {
namespace {

constexpr double kFarthest_m = 1e6, kLeastScale = 1e-6, kMostScale = 1e6, kMostEmission = 65504.0;

std::vector<std::string> split(const std::string& text, char separator)
{
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

std::string joined(const std::vector<std::string>& words)
{
    std::string all;
    for (const std::string& word : words) all.append(all.empty() ? "" : ", ").append(word);
    return all;
}

std::string short_text(double value)
{
    char text[32];
    return {text, std::to_chars(text, std::end(text), value).ptr};
}

// One word NAME=VALUE of an object.
struct Word {
    std::string name, value;

    [[noreturn]] void refuse(const std::string& fault) const
    {
        throw std::runtime_error(name + "=" + value + " " + fault);
    }
    double number(const std::string& text, double min, double max) const
    {
        double number = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
            refuse("has '" + text + "', which is not a number");
        if (number < min || number > max) refuse("is out of range " + short_text(min) + " .. " + short_text(max));
        return number;
    }
    double number(double min, double max) const { return number(value, min, max); }
    // Three numbers, or one that stands for three where `one_will_do`.
    glm::dvec3 vector(double min, double max, bool one_will_do) const
    {
        const std::vector<std::string> parts = split(value, ',');
        if (parts.size() == 1 && one_will_do) return glm::dvec3(number(min, max));
        if (parts.size() != 3) refuse(one_will_do ? "needs 1 number or 3" : "needs 3 numbers");
        return {number(parts[0], min, max), number(parts[1], min, max), number(parts[2], min, max)};
    }
};

// Whether it is a word of the material.
bool read_material(const Word& word, ObjectMaterial& material)
{
    if (word.name == "color")
        material.color = glm::vec3(word.vector(0.0, 1.0, true));
    else if (word.name == "metallic")
        material.metallic = float(word.number(0.0, 1.0));
    else if (word.name == "roughness")
        material.roughness = float(word.number(0.0, 1.0));
    else if (word.name == "specular")
        material.specular = float(word.number(0.0, 1.0));
    else if (word.name == "emission")
        material.emission = glm::vec3(word.vector(0.0, kMostEmission, true));
    else
        return false;
    return true;
}

void read_word(const std::string& text, Object& object)
{
    if (text == "dynamic" || text == "static") {
        object.dynamic = text == "dynamic";
        return;
    }
    const std::size_t equals = text.find('=');
    const Word word{text.substr(0, equals), equals == std::string::npos ? "" : text.substr(equals + 1)};
    ObjectMaterial material = object.material.value_or(ObjectMaterial{});
    if (equals != std::string::npos && word.name == "at")
        object.at = word.vector(-kFarthest_m, kFarthest_m, false);
    else if (equals != std::string::npos && word.name == "turn")
        object.turn_degrees = word.vector(-360.0, 360.0, false);
    else if (equals != std::string::npos && word.name == "scale")
        object.scale = word.vector(kLeastScale, kMostScale, true);
    else if (equals != std::string::npos && read_material(word, material))
        object.material = material;
    else
        throw std::runtime_error("'" + text +
                                 "' is none of at=, turn=, scale=, color=, metallic=, roughness=, specular=, " +
                                 "emission=, dynamic, static");
}

bool is_file(const std::string& source) { return source.ends_with(".glb") || source.ends_with(".gltf"); }

// The shortest that is read back as the same; 1e+30 without its plus, which would join objects.
template <typename Number>
std::string number_text(Number value)
{
    char text[32];
    std::string all(text, std::to_chars(text, std::end(text), value + Number(0)).ptr);  // + 0: no negative zero
    std::erase(all, '+');
    return all;
}

template <typename Vector>
std::string vector_text(const Vector& v)
{
    if (v.x == v.y && v.y == v.z) return number_text(v.x);
    return number_text(v.x) + "," + number_text(v.y) + "," + number_text(v.z);
}

template <typename Vector>
std::string three_text(const Vector& v)
{
    return number_text(v.x) + "," + number_text(v.y) + "," + number_text(v.z);
}

std::string text_of(const Object& object)
{
    std::string text = object.source;
    if (object.at != glm::dvec3(0.0)) text += ":at=" + three_text(object.at);
    if (object.turn_degrees != glm::dvec3(0.0)) text += ":turn=" + three_text(object.turn_degrees);
    if (object.scale != glm::dvec3(1.0)) text += ":scale=" + vector_text(object.scale);
    if (object.material) {
        const ObjectMaterial& material = *object.material;
        text += ":color=" + vector_text(material.color);  // always: without a word there is no material
        if (material.metallic != 0.0f) text += ":metallic=" + number_text(material.metallic);
        if (material.roughness != 1.0f) text += ":roughness=" + number_text(material.roughness);
        if (material.specular != 1.0f) text += ":specular=" + number_text(material.specular);
        if (material.emission != glm::vec3(0.0f)) text += ":emission=" + vector_text(material.emission);
    }
    if (object.dynamic) text += ":dynamic";
    return text;
}

}  // namespace

std::vector<Object> parse_objects(const std::string& text)
{
    std::vector<Object> objects;
    if (text.empty()) return objects;
    for (const std::string& part : split(text, '+')) {
        const std::vector<std::string> words = split(part, ':');
        Object object;
        object.source = words[0];
        const std::string where = "object " + std::to_string(objects.size() + 1) + " '" + object.source + "': ";
        if (objects.size() == kMostObjects)
            throw std::runtime_error("more than " + std::to_string(kMostObjects) + " objects");
        if (!shape_from_name(object.source) && !is_file(object.source))
            throw std::runtime_error(where + "is none of " + joined(shape_names()) + ", and no .glb or .gltf file");
        try {
            for (std::size_t i = 1; i < words.size(); ++i) read_word(words[i], object);
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(where + error.what());
        }
        objects.push_back(object);
    }
    return objects;
}

std::string text_of(const std::vector<Object>& objects)
{
    std::string text;
    for (const Object& object : objects) text.append(text.empty() ? "" : "+").append(text_of(object));
    return text;
}

std::string objects_help()
{
    return "things put into the scene: SHAPE or FILE.glb, then :at=x,y,z (m) :turn=x,y,z (degrees) :scale=s or x,y,z "
           ":color=r,g,b :metallic=m :roughness=r :specular=s :emission=r,g,b (W/(sr m2)) :dynamic; joined by +. "
           "Shapes: " +
           joined(shape_names());
}

}  // namespace conebook
