#include "05_atomic_averaging/naive_average.hpp"

#include <algorithm>
#include <cmath>

namespace conebook {

NaiveAverage::NaiveAverage(gl::Shaders& shaders) : programs_(shaders, "05_atomic_averaging/naive_average.comp")
{
}

void NaiveAverage::run(const GpuScene& scene, const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer,
                       Averaging averaging)
{
    if (!color_ || color_.size() != grid.size()) color_ = gl::texture_3d("naive mean", GL_R32UI, grid.size());
    color_.clear();
    color_.bind_image(0, 0, GL_READ_WRITE);
    programs_.run(scene, grid, voxelizer.fragments(),
                  {{"RACING_STORE", averaging == Averaging::racing_store ? "1" : "0"},
                   {"TRUNCATING", averaging == Averaging::compare_and_swap_truncating ? "1" : "0"}});
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

double rms_error(const NaiveAverage& naive, const VoxelFaces& faces)
{
    const std::vector<GLuint> texels = gl::read_uints(naive.color()), entries = gl::read_uints(faces.face_index());
    const auto exact = faces.faces().read<shared::VoxelFace>();
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const GLuint mask = entries[i] & 63u;
        if (mask == 0u || (mask & (mask - 1u)) != 0u) continue;
        for (int c = 0; c < 3; ++c) {
            const double got = double(texels[i] >> (8 * c) & 255u) / 255.0;
            const double difference = got - double(exact[entries[i] >> 6].albedo_area[c]);
            sum += difference * difference;
            count += 1.0;
        }
    }
    return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

void ChangeCounter::look(const VoxelFaces& faces, const NaiveAverage* naive)
{
    const std::vector<GLuint> now = naive != nullptr ? gl::read_uints(naive->color()) : faces.faces().read<GLuint>();
    if (first_.empty()) first_ = now;
    double changed = 0.0;
    for (std::size_t i = 0; i < std::min(now.size(), first_.size()); ++i) changed += now[i] != first_[i] ? 1.0 : 0.0;
    most_changed_ = std::max(most_changed_, changed);
}

}  // namespace conebook
