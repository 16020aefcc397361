#include "image/write_file.hpp"

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

#include <unistd.h>

namespace conebook {

namespace {

std::runtime_error fault(const std::filesystem::path& file, const std::string& reason)
{
    return std::runtime_error(file.string() + ": cannot be written: " + reason);
}

// In the same folder, since a rename is atomic within one file system only.
std::filesystem::path temporary_for(const std::filesystem::path& file)
{
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
        throw fault(file, "folder " + folder.string() + " does not exist");
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (std::filesystem::is_directory(status)) throw fault(file, "it is a folder");
    // A rename would put a file in the place of a device such as /dev/null.
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw fault(file, "it is no file");
    std::string hidden(1, '.');
    hidden += file.filename().string();
    hidden += '.';
    hidden += std::to_string(getpid());
    hidden += ".part";
    return folder / hidden;
}

void write_temporary(const std::filesystem::path& file, const std::filesystem::path& temporary, std::string_view bytes)
{
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    if (!out) throw fault(file, "its folder takes none (" + std::generic_category().message(errno) + ")");
    out.write(bytes.data(), std::streamsize(bytes.size()));
    out.close();
    if (out) return;
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw fault(file, "disk full or write error");
}

}  // namespace

void write_file(const std::filesystem::path& file, std::string_view bytes)
{
    const std::filesystem::path temporary = temporary_for(file);
    write_temporary(file, temporary, bytes);
    std::error_code error, ignored;
    std::filesystem::rename(temporary, file, error);
    if (!error) return;
    std::filesystem::remove(temporary, ignored);
    throw fault(file, error.message());
}

void check_writable(const std::filesystem::path& file)
{
    const std::filesystem::path temporary = temporary_for(file);
    write_temporary(file, temporary, "");
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
}

}  // namespace conebook
