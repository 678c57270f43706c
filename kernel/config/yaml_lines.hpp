// Indented YAML lines; for the writers of this room only.
#pragma once

#include <fmt/format.h>
#include <string>
#include <string_view>

#include "kernel/config/case.hpp"
#include "kernel/config/units.hpp"

namespace millscope::config {

inline std::string vector_text(const double* v) {
  return fmt::format("[{}, {}, {}]", number_text(v[0]), number_text(v[1]), number_text(v[2]));
}
inline std::string vector_text(const Vector3& v) { return vector_text(v.data()); }

/// Indented lines of a YAML map.
class Lines {
 public:
  void value(std::string_view key, const std::string& text) { out_ += fmt::format("{:{}}{}: {}\n", "", indent_, key, text); }
  void value(std::string_view key, double number) { value(key, number_text(number)); }
  void open(std::string_view key) {
    out_ += fmt::format("{:{}}{}:\n", "", indent_, key);
    indent_ += 2;
  }
  void close() { indent_ -= 2; }
  const std::string& text() const { return out_; }

 private:
  std::string out_;
  int indent_ = 0;
};

/// Sections without plugins.
void write_head(Lines& out, const Case& c);
void write_materials(Lines& out, const Case& c);
void write_beads(Lines& out, const std::vector<BeadCase>& beads);
void write_fill(Lines& out, const FillCase& fill);
void write_mill(Lines& out, const std::optional<MillCase>& mill);
void write_motion(Lines& out, const MotionCase& motion);
void write_domain(Lines& out, const DomainCase& domain);
void write_time(Lines& out, const TimeCase& time);
void write_start(Lines& out, const std::optional<StartCase>& start);
void write_output(Lines& out, const OutputCase& output);
void write_run(Lines& out, const RunCase& run);

}  // namespace millscope::config
