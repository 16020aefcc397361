// Parameters that `--set NAME=VALUE` changes: each is a field of some pass's struct, entered in a table by name.
#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace conebook {

struct Parameter {
    std::string name{}, unit{}, help{};
    double min = 0.0, max = 0.0;
    float* as_float = nullptr;  // one of these three is set, or as_text, or the two functions of an enumeration
    int* as_int = nullptr;
    bool* as_bool = nullptr;
    std::string* as_text = nullptr;  // it has no number, so that value() and default_value are 0
    std::function<int()> choice{};
    std::function<void(int)> choose{};
    std::vector<std::string> choices{};  // an enumeration's values by name, 0, 1, 2, ...
    std::vector<int> values{};           // with as_int: the only ones allowed, if any
    double default_value = 0.0;
    std::string default_text{};  // "none" stands for an empty one wherever it is written
    std::function<void(const std::string&)> check{};  // of a text: throws std::runtime_error with what is wrong with it
    double value() const;
    void set(double value) const;  // into the field; must be one of those allowed
    bool is_default() const;
    std::string value_text(double value) const;  // a text's, whatever `value`: the field's
    std::string default_word() const;            // value_text of the default
    std::string range_text() const;
};

// Of all parameters, in their order.
struct ParameterValues {
    std::vector<double> numbers;     // 0 for texts
    std::vector<std::string> texts;  // "" for numbers
    bool operator==(const ParameterValues&) const = default;
};

// The fields must outlive the table.
class ParameterTable {
public:
    void add(const std::string& name, float& field, double min, double max, const std::string& unit,
             const std::string& help);
    void add(const std::string& name, int& field, int min, int max, const std::string& unit, const std::string& help);
    void add_values(const std::string& name, int& field, std::vector<int> values, const std::string& help);  // one of them
    void add(const std::string& name, bool& field, const std::string& help);
    // An enumeration, or an integer, whose values are 0, 1, 2, ... by the names in `choices`.
    template <typename Enum>
        requires(std::is_enum_v<Enum> || std::is_same_v<Enum, int>)
    void add(const std::string& name, Enum& field, std::vector<std::string> choices, const std::string& help)
    {
        add_choice(
            name, [&field] { return int(field); }, [&field](int value) { field = Enum(value); }, std::move(choices), help);
    }
    void add(const std::string& name, std::string& field, std::function<void(const std::string&)> check,
             const std::string& help);

    // "NAME=VALUE" of the command line. Throws as the other one does, with --set before the name.
    void set(const std::string& assignment);
    // Throws std::runtime_error that begins with the name when no parameter is called so, and when the value is no finite
    // number, out of range or none of the choices, or a text that its check refuses.
    void set(const std::string& name, const std::string& text);
    const std::vector<Parameter>& all() const { return parameters_; }
    ParameterValues values() const;
    void set_values(const ParameterValues& values);  // the same, as values() gives them; texts are not checked
    // " NAME=VALUE" of each that is not the default, as set() takes it, to the last bit; quoted where a shell needs that.
    std::string changed() const;
    // One line a parameter: name, default, range, unit, help.
    std::string listing() const;

private:
    void add_choice(const std::string& name, std::function<int()> choice, std::function<void(int)> choose,
                    std::vector<std::string> choices, const std::string& help);
    void insert(Parameter parameter);
    std::vector<Parameter> parameters_;
};

// A table of several structs' fields, by their overloads of add_parameters(ParameterTable&, Params&).
template <typename... Params>
ParameterTable parameters_of(Params&... params)
{
    ParameterTable table;
    (add_parameters(table, params), ...);
    return table;
}

}  // namespace conebook
