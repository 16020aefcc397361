// Parameters that `--set NAME=VALUE` changes: each is a field of some pass's struct, entered in a table by name.
#pragma once

#include <string>
#include <vector>

namespace conebook {

struct Parameter {
    std::string name, unit, help;
    double min = 0.0, max = 0.0;
    float* as_float = nullptr;            // exactly one of the three is set
    int* as_int = nullptr;
    bool* as_bool = nullptr;
    std::vector<std::string> choices;     // with as_int: its values by name, 0, 1, 2, ...
    std::vector<int> values;              // with as_int and no choices: the only ones allowed, if any
    double default_value = 0.0;
    std::string value_text(double value) const;
    std::string range_text() const;
};

// The fields must outlive the table.
class ParameterTable {
public:
    void add(const std::string& name, float& field, double min, double max, const std::string& unit,
             const std::string& help);
    void add(const std::string& name, int& field, int min, int max, const std::string& unit, const std::string& help);
    void add_values(const std::string& name, int& field, std::vector<int> values, const std::string& help);  // one of them
    void add(const std::string& name, bool& field, const std::string& help);
    void add(const std::string& name, int& field, std::vector<std::string> choices, const std::string& help);

    // "NAME=VALUE". Throws std::runtime_error for an unknown name, a value that is no finite number or out of range.
    void set(const std::string& assignment);
    const std::vector<Parameter>& all() const { return parameters_; }
    std::vector<double> values() const;  // of all, in their order
    // One line a parameter: name, default, range, unit, help.
    std::string listing() const;

private:
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
