// manual: the page that `man millscope` shows, from the commands' own tables.
#include <fmt/core.h>

#include <cstdint>

#include "app/tables.hpp"
#include "kernel/base/program.hpp"

namespace millscope::app {
namespace {

/// UTF-8 as \[uXXXX], so that groff needs no locale; what troff would take for a command of its own, escaped.
std::string escaped(std::string_view text) {
  std::string out;
  bool begins_line = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned char c = static_cast<unsigned char>(text[i]);
    if (begins_line && (c == '.' || c == '\'')) out += "\\&";
    begins_line = c == '\n';
    if (c == '\\') {
      out += "\\(rs";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '"') {
      out += "\\(dq";
    } else if (c == '\'') {
      out += "\\(aq";
    } else if (c == '`') {
      out += "\\(ga";
    } else if (c == '~') {
      out += "\\(ti";
    } else if (c == '^') {
      out += "\\(ha";
    } else if (c < 0x80) {
      out += static_cast<char>(c);
    } else {
      const std::size_t more = c >= 0xF0 ? 3 : c >= 0xE0 ? 2 : 1;
      std::uint32_t code = c & (0x3FU >> more);
      for (std::size_t k = 0; k < more && i + 1 < text.size(); ++k) code = (code << 6U) | (static_cast<unsigned char>(text[++i]) & 0x3FU);
      out += fmt::format("\\[u{:04X}]", code);
    }
  }
  return out;
}

void print_paragraph(std::string_view text) { fmt::print("{}\n", escaped(text)); }

void print_tagged(const std::string& tag, const std::string& text) { fmt::print(".TP\n\\fB{}\\fR\n{}\n", escaped(tag), escaped(text)); }

void print_command(const CommandTable& table) {
  fmt::print(".SS \"{}\"\n", escaped("millscope " + table.usage));
  print_paragraph(table.page);
  for (const PositionEntry& p : table.positions) print_tagged(p.name, p.what);
  for (const OptionEntry& o : table.options) {
    if (o.name == "help") continue;  // said once, for all
    print_tagged((o.letter.empty() ? "" : "-" + o.letter + ", ") + "--" + o.name + (o.value.empty() ? "" : " " + o.value), o.what);
  }
  fmt::print(".PP\nExample:\n.PP\n.RS\n.nf\n{}\n.fi\n.RE\n", escaped(table.example));
}

}  // namespace

int manual(const Arguments& arguments) {
  Options options("manual", "Prints the manual page in troff's language; 'make install' installs it.", "millscope manual > millscope.1");
  if (!options.parse(arguments)) return kDone;
  const std::vector<CommandTable> tables = all_tables();
  fmt::print(".TH MILLSCOPE 1 \"\" \"millscope {}\" \"User Commands\"\n.SH NAME\nmillscope \\- see inside a tumbling mill\n",
             base::version());
  fmt::print(".SH SYNOPSIS\n.B millscope\n.I COMMAND\n[\\fIARGUMENT\\fR ...]\n.br\n.B millscope\n.I COMMAND\n.B \\-\\-help\n");
  fmt::print(".SH DESCRIPTION\n");
  print_paragraph(
      "Simulates the charge of a tumbling mill bead by bead (discrete element method), measures recordings of tracers in real mills the "
      "same way, finds contact parameters from them and names physics that a simulation leaves out. Particles are spheres.");
  fmt::print(".SH COMMANDS\n");
  for (const CommandTable& t : tables) print_tagged(t.name, t.what);
  fmt::print(".SH USAGE\n");
  print_paragraph("Each command explains itself with --help.");
  for (const CommandTable& t : tables) {
    if (t.actions.empty()) print_command(t);
    for (const CommandTable& action : t.actions) print_command(action);
  }
  fmt::print(".SH \"EXIT STATUS\"\n");
  for (const ExitCode& e : kExitCodes) print_tagged(std::to_string(e.code), e.means);
  fmt::print(".SH \"SEE ALSO\"\n");
  print_paragraph(
      "millscope describe PLUGIN for equations, citations and parameters of plugins; millscope schema for the keys of case files.");
  return kDone;
}

}  // namespace millscope::app
