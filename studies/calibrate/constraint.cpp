// Inequalities between parameters.
#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "kernel/base/nearest.hpp"
#include "studies/calibrate/study_sections.hpp"

#include "kernel/base/text.hpp"

namespace millscope::calibrate {
namespace {

std::optional<double> number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// factor · parameter, or a bare number where there is no parameter.
struct Operand {
  double factor = 1;
  std::optional<Eigen::Index> parameter = std::nullopt;
  double value(const Eigen::VectorXd& point) const { return parameter ? factor * point[*parameter] : factor; }
};

Operand read_operand(const config::Node& node, const std::string& text, const std::vector<Parameter>& parameters) {
  Operand operand;
  std::string name = base::trimmed(text);
  if (const auto alone = number(name)) return {*alone, std::nullopt};
  if (const std::size_t star = name.find('*'); star != std::string::npos) {
    const auto factor = number(base::trimmed(name.substr(0, star)));
    if (!factor)
      node.fail(fmt::format("is '{}': '{}' is no number; write e.g. a < 0.5 * b", node.text(), base::trimmed(name.substr(0, star))));
    operand.factor = *factor;
    name = base::trimmed(name.substr(star + 1));
  }
  operand.parameter = find_parameter(parameters, name);
  if (operand.parameter) return operand;
  std::vector<std::string> known;
  for (const Parameter& p : parameters) known.push_back(p.name);
  node.fail(fmt::format("is '{}': '{}' is no parameter of this study; {}", node.text(), name, base::suggestion(name, known)));
}

}  // namespace

Constraint read_constraint(const config::Node& node, const std::vector<Parameter>& parameters) {
  const std::string& text = node.text();
  const std::size_t sign = text.find_first_of("<>");
  if (sign == std::string::npos) node.fail(fmt::format("is '{}': no inequality; write e.g. mu_r < mu_s", text));
  const bool strict = sign + 1 >= text.size() || text[sign + 1] != '=';
  const Operand left = read_operand(node, text.substr(0, sign), parameters);
  const Operand right = read_operand(node, text.substr(sign + (strict ? 1 : 2)), parameters);
  const Operand small = text[sign] == '<' ? left : right, large = text[sign] == '<' ? right : left;
  return {text, [small, large, strict](const Eigen::VectorXd& point) {
            const double a = small.value(point), b = large.value(point);
            return strict ? a < b : a <= b;
          }};
}

}  // namespace millscope::calibrate
