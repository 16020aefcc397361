// The shaders of the book together with those of the tests. Header only.
#pragma once

#include <filesystem>
#include <optional>

#include "temporary_folder.hpp"
#include "test_gl.hpp"

namespace conebook {

// A folder of the shaders of the book and, in tests/, of those of the tests.
class TestShaders {
public:
    TestShaders()
    {
        test_gl();  // a context for them
        namespace fs = std::filesystem;
        const fs::path root = TestGl::root();
        for (const auto& entry : fs::directory_iterator(root / "shaders"))
            fs::create_directory_symlink(fs::absolute(entry.path()), folder_ / entry.path().filename());
        fs::create_directory_symlink(fs::absolute(root / "tests" / "shaders"), folder_ / "tests");
        shaders.emplace(folder_.path());
    }
    std::optional<gl::Shaders> shaders;

private:
    TemporaryFolder folder_;
};

}  // namespace conebook
