// Files that are whole or not there.
#pragma once

#include <filesystem>
#include <string_view>

namespace conebook {

// The bytes go to a temporary in the same folder, then take the file's name, so that nothing is left half-written.
// Throws std::runtime_error that names the file and the reason.
void write_file(const std::filesystem::path& file, std::string_view bytes);

// Throws as write_file would; leaves nothing behind. For asking before long work.
void check_writable(const std::filesystem::path& file);

}  // namespace conebook
