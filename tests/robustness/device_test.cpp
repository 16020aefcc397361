// Which device draws: what --list-devices names, --device and $CONEBOOK_DEVICE choose, and what is said when there is none.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program.hpp"
#include "statistics_file.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

const char* const kProgram = "01_first_light";

// A variable of the environment that has its old value again when this object goes.
class Variable {
public:
    Variable(const char* name, const std::string& value) : name_(name)
    {
        if (const char* before = std::getenv(name)) before_ = before;
        setenv(name, value.c_str(), 1);
    }
    ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    const char* name_;
    std::optional<std::string> before_;
};

struct Listed {
    std::string number, driver, kind;
    bool works() const { return driver.rfind("- ", 0) != 0; }
    std::string renderer() const { return driver.substr(0, driver.find_first_of(" ,")); }  // its first word
};

std::vector<Listed> listed_devices()
{
    const ProgramRun run = run_program(kProgram, "--list-devices");
    EXPECT_EQ(run.code, 0) << run.output;
    std::vector<Listed> devices;
    std::istringstream lines(run.output);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream fields(line);
        Listed device;
        std::getline(fields, device.number, '\t');
        std::getline(fields, device.driver, '\t');
        std::getline(fields, device.kind);
        devices.push_back(device);
    }
    return devices;
}

// The driver that a run with these arguments says it had.
std::string driver_of(const std::string& arguments)
{
    const TemporaryFolder folder;
    const std::string file = (folder / "x.json").string();
    const ProgramRun run = run_program(kProgram, "--headless --size 16x16 --stats '" + file + "' " + arguments);
    EXPECT_EQ(run.code, 0) << run.output;
    EXPECT_EQ(run.output, "");
    return run.code == 0 ? read_statistics(file).at("driver").get<std::string>() : "";
}

void expect_refusal(const std::string& arguments, const std::string& part)
{
    SCOPED_TRACE(arguments);
    const TemporaryFolder folder;
    const ProgramRun run =
        run_program(kProgram, "--size 16x16 --output '" + (folder / "x.png").string() + "' " + arguments);
    EXPECT_EQ(run.code, 1);
    EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    EXPECT_NE(run.output.find(part), std::string::npos) << run.output;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Devices, AreNumberedGpusFirst)
{
    const std::vector<Listed> devices = listed_devices();
    ASSERT_FALSE(devices.empty());
    bool cpu_before = false;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        SCOPED_TRACE(devices[i].driver + " " + devices[i].kind);
        EXPECT_EQ(devices[i].number, std::to_string(i));
        EXPECT_TRUE(devices[i].kind.rfind("GPU", 0) == 0 || devices[i].kind == "CPU" ||
                    devices[i].kind == "surfaceless");
        EXPECT_FALSE(cpu_before && devices[i].kind.rfind("GPU", 0) == 0);
        cpu_before = cpu_before || devices[i].kind == "CPU";
    }
}

TEST(Devices, EachDrawsWhenItIsChosen)
{
    for (const Listed& device : listed_devices()) {
        if (!device.works()) {
            expect_refusal("--headless --device " + device.number, "--device " + device.number);
            continue;
        }
        EXPECT_EQ(driver_of("--device " + device.number), device.driver);
        std::string part = device.renderer();
        EXPECT_EQ(driver_of("--device " + part).rfind(part, 0), 0u);
        std::transform(part.begin(), part.end(), part.begin(), [](unsigned char c) { return std::toupper(c); });
        EXPECT_EQ(driver_of("--device " + part).rfind(device.renderer(), 0), 0u);
        const Variable variable("CONEBOOK_DEVICE", device.number);
        EXPECT_EQ(driver_of(""), device.driver);
    }
}

TEST(Devices, WithoutAChoiceTheFirstThatWorks)
{
    const std::vector<Listed> devices = listed_devices();
    const auto first = std::find_if(devices.begin(), devices.end(), [](const Listed& d) { return d.works(); });
    ASSERT_NE(first, devices.end());
    EXPECT_EQ(driver_of(""), first->driver);
}

TEST(Devices, TheOptionStandsAboveTheVariable)
{
    const Variable variable("CONEBOOK_DEVICE", "no such renderer");
    expect_refusal("--headless", "CONEBOOK_DEVICE=no such renderer");
    EXPECT_NE(driver_of("--device 0"), "");
}

TEST(Devices, UnknownOnesAreRefused)
{
    for (const char* device : {"99", "99999999999999999999", "no_such_renderer", "0x", "-1"})
        expect_refusal("--headless --device=" + std::string(device), "--list-devices");
    expect_refusal("--device 0", "--headless");
}

TEST(Devices, WithoutADriverOneLineSaysSo)
{
    const Variable variable("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null");
    expect_refusal("--headless", "libgl1-mesa-dri");
    expect_refusal("--headless --device 0", "libgl1-mesa-dri");
    expect_refusal("--list-devices", "libgl1-mesa-dri");
}

}  // namespace
}  // namespace conebook
