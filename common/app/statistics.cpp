#include "app/statistics.hpp"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "image/write_file.hpp"

namespace conebook {

namespace {

double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

double minimum(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

}  // namespace

const char* scope_name(Scope scope)
{
    return scope == Scope::scene ? "scene" : scope == Scope::light ? "light" : "camera";
}

std::vector<PassTime> Statistics::last_times() const
{
    std::vector<PassTime> all;
    for (const std::string& name : pass_order_) {
        const Pass& pass = passes_.at(name);
        all.push_back({name, pass.scope, pass.times_ms.back()});
    }
    return all;
}

void Statistics::add_time(const std::string& pass, Scope scope, double milliseconds)
{
    Pass& timed = passes_[pass];
    if (timed.times_ms.empty()) pass_order_.push_back(pass);
    timed.scope = scope;
    timed.times_ms.push_back(milliseconds);
}

void Statistics::write_json(const std::filesystem::path& file) const
{
    nlohmann::ordered_json json;
    json["program"] = program_;
    json["driver"] = driver_;
    json["size"] = {size_.x, size_.y};
    json["seed"] = 0;  // nothing in the chapters is random
    json["passes"] = nlohmann::json::array();
    for (const std::string& pass : pass_order_) {
        const std::vector<double>& times = passes_.at(pass).times_ms;
        json["passes"].push_back({{"name", pass},
                                  {"scope", scope_name(passes_.at(pass).scope)},
                                  {"min_ms", minimum(times)},
                                  {"median_ms", median(times)},
                                  {"frames", times.size()}});
    }
    json["resources"] = nlohmann::json::array();
    for (const gl::Resource& r : resources_) json["resources"].push_back({{"name", r.name}, {"bytes", r.bytes}});
    json["needed"] = nlohmann::json::array();
    for (const Need& n : needs_) json["needed"].push_back({{"name", n.name}, {"used", n.used}, {"reason", n.reason}});
    json["counts"] = nlohmann::json::array();
    for (const Count& c : counts_) json["counts"].push_back({{"name", c.name}, {"value", c.value}, {"unit", c.unit}});
    if (!plan_.empty()) json["plan"] = nlohmann::json::array();
    for (const PlanLine& line : plan_)
        json["plan"].push_back({{"kind", line.kind},
                                {"name", line.name},
                                {"used", line.used},
                                {"bytes", line.bytes},
                                {"ms", line.milliseconds},
                                {"reason", line.reason}});

    write_file(file, json.dump(1) + "\n");
}

std::string Statistics::table() const
{
    std::string out;
    char line[256];
    const auto row = [&](const char* format, auto... values) {
        std::snprintf(line, sizeof line, format, values...);
        out += line;
    };
    row("%s, %d x %d, %s\n", program_.c_str(), size_.x, size_.y, driver_.c_str());
    row("%-26s %7s %12s %12s %6s\n", "pass", "scope", "min ms", "median ms", "times");
    double total = 0.0;
    for (const std::string& pass : pass_order_) {
        const std::vector<double>& times = passes_.at(pass).times_ms;
        row("%-26s %7s %12.2f %12.2f %6zu\n", pass.c_str(), scope_name(passes_.at(pass).scope), minimum(times),
            median(times), times.size());
        total += median(times);
    }
    row("%-26s %7s %12s %12.2f\n", "sum of all, once", "", "", total);
    row("%-34s %12s\n", "resource", "bytes");
    std::size_t bytes = 0;
    for (const gl::Resource& r : resources_) {
        row("%-34s %12zu\n", r.name.c_str(), r.bytes);
        bytes += r.bytes;
    }
    row("%-34s %12zu\n", "sum", bytes);
    for (const Count& c : counts_) row("%-34s %12.6g %s\n", c.name.c_str(), c.value, c.unit.c_str());
    for (const Need& n : needs_) row("%-34s %12s %s\n", n.name.c_str(), n.used ? "used" : "left out", n.reason.c_str());
    return out;
}

}  // namespace conebook
