// What a program wrote with --stats. Header only.
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

namespace conebook {

inline nlohmann::json read_statistics(const std::filesystem::path& file)
{
    return nlohmann::json::parse(std::ifstream(file));
}

// The entry with this name of a list ("passes", "resources", "needed", "counts"); null when there is none.
inline nlohmann::json named(const nlohmann::json& stats, const char* list, const std::string& name)
{
    for (const nlohmann::json& entry : stats.at(list))
        if (entry.at("name") == name) return entry;
    return nullptr;
}

inline double count_of(const nlohmann::json& stats, const std::string& name)
{
    const nlohmann::json count = named(stats, "counts", name);
    if (count.is_null()) throw std::runtime_error("no count " + name);
    return count.at("value");
}

}  // namespace conebook
