#include "app/parameters.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <stdexcept>

namespace conebook {

namespace {

std::string number_text(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

std::string joined(const std::vector<std::string>& words)
{
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : " | ") + word;
    return out;
}

std::string padded(std::string text, std::size_t width)
{
    text.resize(std::max(text.size() + 1, width), ' ');
    return text;
}

constexpr const char* kNoText = "none";

// A word of a shell.
std::string quoted(const std::string& text)
{
    const auto is_plain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
               std::string("=.,:+-_/%@").find(c) != std::string::npos;
    };
    if (std::all_of(text.begin(), text.end(), is_plain)) return text;
    std::string out(1, '\'');
    for (const char c : text) {
        if (c == '\'')
            out.append("'\\''");
        else
            out.push_back(c);
    }
    out.push_back('\'');
    return out;
}

double parse_number(const std::string& name, const std::string& text)
{
    std::size_t used = 0;
    double value = 0.0;
    try {
        value = std::stod(text, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (text.empty() || used != text.size() || !std::isfinite(value))
        throw std::runtime_error(name + "=" + text + ": not a finite number");
    return value;
}

}  // namespace

double Parameter::value() const
{
    if (as_text != nullptr) return 0.0;
    if (choice) return double(choice());
    return as_float != nullptr ? double(*as_float) : as_int != nullptr ? double(*as_int) : double(*as_bool);
}

void Parameter::set(double value) const
{
    if (as_float != nullptr) *as_float = float(value);
    if (as_int != nullptr) *as_int = int(value);
    if (as_bool != nullptr) *as_bool = value != 0.0;
    if (choose) choose(int(value));
}

bool Parameter::is_default() const { return as_text != nullptr ? *as_text == default_text : value() == default_value; }

std::string Parameter::value_text(double value) const
{
    if (as_text != nullptr) return as_text->empty() ? kNoText : *as_text;
    if (!choices.empty()) return choices[std::size_t(value)];
    if (as_bool != nullptr) return value != 0.0 ? "on" : "off";
    return number_text(value);
}

std::string Parameter::default_word() const
{
    if (as_text != nullptr) return default_text.empty() ? kNoText : default_text;
    return value_text(default_value);
}

std::string Parameter::range_text() const
{
    if (!choices.empty()) return joined(choices);
    if (as_bool != nullptr) return "on | off";
    if (as_text != nullptr) return "text";
    if (!values.empty()) {
        std::vector<std::string> words;
        for (const int v : values) words.push_back(std::to_string(v));
        return joined(words);
    }
    return number_text(min) + " .. " + number_text(max);
}

void ParameterTable::insert(Parameter parameter)
{
    for (const Parameter& other : parameters_)
        if (other.name == parameter.name) throw std::logic_error("parameter " + parameter.name + " is entered twice");
    parameters_.push_back(std::move(parameter));
}

void ParameterTable::add(const std::string& name, float& field, double min, double max, const std::string& unit,
                         const std::string& help)
{
    insert({.name = name, .unit = unit, .help = help, .min = min, .max = max, .as_float = &field, .default_value = field});
}

void ParameterTable::add(const std::string& name, int& field, int min, int max, const std::string& unit,
                         const std::string& help)
{
    insert({.name = name,
            .unit = unit,
            .help = help,
            .min = double(min),
            .max = double(max),
            .as_int = &field,
            .default_value = double(field)});
}

void ParameterTable::add_values(const std::string& name, int& field, std::vector<int> values, const std::string& help)
{
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    insert({.name = name,
            .help = help,
            .min = double(*least),
            .max = double(*most),
            .as_int = &field,
            .values = values,
            .default_value = double(field)});
}

void ParameterTable::add(const std::string& name, bool& field, const std::string& help)
{
    insert({.name = name, .help = help, .max = 1.0, .as_bool = &field, .default_value = field ? 1.0 : 0.0});
}

void ParameterTable::add_choice(const std::string& name, std::function<int()> choice, std::function<void(int)> choose,
                                std::vector<std::string> choices, const std::string& help)
{
    const double last = double(choices.size()) - 1.0, now = double(choice());
    insert({.name = name,
            .help = help,
            .max = last,
            .choice = std::move(choice),
            .choose = std::move(choose),
            .choices = std::move(choices),
            .default_value = now});
}

void ParameterTable::add(const std::string& name, std::string& field, std::function<void(const std::string&)> check,
                         const std::string& help)
{
    insert({.name = name, .help = help, .as_text = &field, .default_text = field, .check = std::move(check)});
}

void ParameterTable::set(const std::string& assignment)
{
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
        throw std::runtime_error("--set " + assignment + ": expected NAME=VALUE");
    try {
        set(assignment.substr(0, equals), assignment.substr(equals + 1));
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(std::string("--set ") + error.what());
    }
}

void ParameterTable::set(const std::string& name, const std::string& text)
{
    const auto found =
        std::find_if(parameters_.begin(), parameters_.end(), [&](const Parameter& p) { return p.name == name; });
    if (found == parameters_.end())
        throw std::runtime_error(name + ": unknown parameter; --list-params names those of this chapter");

    if (found->as_text != nullptr) {
        const std::string value = text == kNoText ? "" : text;
        try {
            found->check(value);
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(name + ": " + error.what());
        }
        *found->as_text = value;
        return;
    }
    if (found->as_bool != nullptr && (text == "on" || text == "true" || text == "off" || text == "false")) {
        *found->as_bool = text == "on" || text == "true";
        return;
    }
    const auto choice = std::find(found->choices.begin(), found->choices.end(), text);
    if (choice != found->choices.end()) {
        found->choose(int(choice - found->choices.begin()));
        return;
    }
    const bool out_of_choices = !found->choices.empty();
    if (out_of_choices) throw std::runtime_error(name + "=" + text + ": must be one of " + found->range_text());
    const double value = parse_number(name, text);
    if (value < found->min || value > found->max)
        throw std::runtime_error(name + "=" + text + ": out of range " + found->range_text() +
                                 (found->unit.empty() ? "" : " " + found->unit));
    if (!found->values.empty() && std::find(found->values.begin(), found->values.end(), value) == found->values.end())
        throw std::runtime_error(name + "=" + text + ": must be one of " + found->range_text());
    const bool whole = found->as_int != nullptr || found->as_bool != nullptr;
    if (whole && value != std::floor(value)) throw std::runtime_error(name + "=" + text + ": must be a whole number");
    found->set(value);
}

ParameterValues ParameterTable::values() const
{
    ParameterValues all;
    for (const Parameter& p : parameters_) {
        all.numbers.push_back(p.value());
        all.texts.push_back(p.as_text != nullptr ? *p.as_text : "");
    }
    return all;
}

void ParameterTable::set_values(const ParameterValues& values)
{
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        parameters_[i].set(values.numbers[i]);
        if (parameters_[i].as_text != nullptr) *parameters_[i].as_text = values.texts[i];
    }
}

std::string ParameterTable::changed() const
{
    std::string out;
    for (const Parameter& p : parameters_) {
        if (p.is_default()) continue;
        char number[32];
        const auto end = p.as_float != nullptr ? std::to_chars(number, std::end(number), *p.as_float).ptr : number;
        out.push_back(' ');
        out += quoted(p.name + "=" + (p.as_float != nullptr ? std::string(number, end) : p.value_text(p.value())));
    }
    return out;
}

std::string ParameterTable::listing() const
{
    std::size_t name_width = 8, value_width = 8, range_width = 8;
    for (const Parameter& p : parameters_) {
        name_width = std::max(name_width, p.name.size() + 2);
        value_width = std::max(value_width, p.default_word().size() + 2);
        range_width = std::max(range_width, p.range_text().size() + 2);
    }
    std::string out;
    for (const Parameter& p : parameters_)
        out += padded(p.name, name_width) + padded(p.default_word(), value_width) +
               padded(p.range_text(), std::min<std::size_t>(range_width, 40)) +
               padded(p.unit.empty() ? "-" : p.unit, 8) + p.help + "\n";
    return out;
}

}  // namespace conebook
