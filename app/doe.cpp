// `millscope doe`: plans of runs and what their results say. Each action is a function with options of its own.
#include <fmt/core.h>

#include <filesystem>

#include "app/actions.hpp"
#include "app/commands.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/config/document.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "studies/doe/analysis.hpp"
#include "studies/doe/plan_table.hpp"
#include "studies/doe/printed.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;
using base::UserError;

std::vector<std::string> split(const Options& options, const char* name) {
  std::vector<std::string> words;
  if (!options.has(name)) return words;
  const std::string text = options.text(name);
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    if (comma == at) throw UserError(fmt::format("--{} '{}': an empty name; separate names by single commas", name, text));
    words.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return words;
}

doe::ModelChoice model_of(const Options& options) {
  const std::string text = options.has("model") ? options.text("model") : "auto";
  if (text == "auto") return doe::ModelChoice::automatic;
  if (text == "main") return doe::ModelChoice::main_effects;
  if (text == "interactions") return doe::ModelChoice::interactions;
  if (text == "quadratic") return doe::ModelChoice::quadratic;
  throw UserError(fmt::format("--model '{}': auto, main, interactions or quadratic", text));
}

int whole(const Options& options, const char* name, int standard) { return options.has(name) ? options.integer(name) : standard; }
double real(const Options& options, const char* name, double standard) { return options.has(name) ? options.number(name) : standard; }

double confidence_of(const Options& options) {
  const double percent = real(options, "confidence", 100 * doe::kConfidence);
  if (!(percent > 0 && percent < 100)) throw UserError(fmt::format("--confidence {}: give percent between 0 and 100", percent));
  return percent / 100;
}

void add_analyze_options(Options& options) {
  using Text = std::string;
  options.add()("factors", po::value<Text>()->value_name("A,B"),
                "columns that were varied (default: the first ones with few, even levels)");
  options.add()("responses", po::value<Text>()->value_name("Y,Z"), "columns that were measured (default: all other numbers)");
  options.add()("generators", po::value<std::vector<Text>>()->value_name("D=A*B*C"),
                "what the runs are said to obey (may be repeated); is checked, and found without being said");
  options.add()("model", po::value<Text>()->value_name("NAME"),
                "main, interactions or quadratic (default: main for a two-level plan, else quadratic)");
  options.add()("axial", po::value<Text>()->value_name("STEPS"),
                "coded distance of axial runs: rotatable, as-written or a number (default: the usual one that rounds to what is written)");
  options.add()("confidence", po::value<double>()->value_name("%"), "of intervals and regions (default: 95)");
  options.add()("descent-step", po::value<double>()->value_name("STEPS"),
                "how far the strongest factor moves in a step of steepest descent (default: 0.5)");
  options.add()("descent-steps", po::value<int>()->value_name("N"), "how many (default: 4)");
  options.add()("printed", po::value<Text>()->value_name("PRINTED.csv"),
                "also hold published figures (columns response, term, figure, printed) against the table");
  options.add()("output,o", po::value<Text>()->value_name("FILE.json"), "write all figures as JSON");
  options.add()("pictures", po::value<Text>()->value_name("DIR"), "draw effects or surfaces, SVG and PNG");
  options.add()("force", "replace FILE.json");
  options.add()("json", "print JSON instead of tables");
  options.add()("quiet,q", "print nothing but errors");
}

int analyze_plan(const Arguments& arguments) {
  Options options(
      "doe analyze TABLE.csv [-o FILE.json]",
      "Says what planned runs tell: effects, analysis of variance and steepest descent of a two-level plan; surface, lack of fit and "
      "stationary point of a second-order plan; runs that stand out, in every response. One line a run, natural units.",
      "millscope doe analyze tests/doe/data/ccd_75.csv");
  options.positional("TABLE", "CSV with a line of names; a first column 'case' or 'run' labels the runs; '#' begins a comment");
  add_analyze_options(options);
  if (!options.parse(arguments)) return kDone;
  const fs::path output = options.has("output") ? fs::path(options.text("output")) : fs::path();
  if (!output.empty() && !options.has("force")) output::refuse_existing(output);
  const doe::Choice choice{split(options, "factors"), split(options, "responses"), options.list("generators"),
                           options.has("axial") ? options.text("axial") : "auto"};
  const doe::Descent descent{real(options, "descent-step", 0.5), whole(options, "descent-steps", 4), 0.1};
  if (!(descent.step > 0 && descent.step < 1000) || descent.steps < 1 || descent.steps > 1000) {
    throw UserError(
        fmt::format("--descent-steps {} of --descent-step {}: give 1 to 1000 steps of a positive length", descent.steps, descent.step));
  }
  const doe::TableAnalysis analysis =
      doe::analyze_table(base::Table::read(options.text("TABLE")), choice, model_of(options), confidence_of(options), descent);
  std::vector<doe::PrintedFigure> printed;
  if (options.has("printed")) printed = doe::compare_printed(analysis, base::Table::read(options.text("printed")));
  nlohmann::ordered_json json = doe::analysis_json(analysis);
  if (!printed.empty()) json["printed"] = doe::printed_json(printed);
  if (!output.empty()) output::write_json(output, json);
  std::size_t drawn = 0;
  if (options.has("pictures")) {
    fs::create_directories(options.text("pictures"));
    drawn = doe::draw_analysis(analysis, options.text("pictures")).size();
  }
  if (options.has("json")) {
    fmt::print("{}\n", json.dump(2));
  } else if (!options.has("quiet")) {
    fmt::print("{}", doe::analysis_text(analysis));
    if (!printed.empty()) fmt::print("\n{}", doe::printed_text(printed));
    if (!output.empty()) fmt::print("all figures: {}\n", output.string());
    if (drawn > 0) fmt::print("{} pictures in {}\n", drawn, options.text("pictures"));
  }
  return kDone;
}

double axial_of(const Options& options, std::size_t factors) {
  const std::string text = options.has("axial") ? options.text("axial") : "rotatable";
  if (text == "rotatable") return doe::rotatable(static_cast<int>(factors));
  if (text == "face-centred") return doe::kFaceCentred;
  try {
    std::size_t read = 0;
    const double value = std::stod(text, &read);
    if (read == text.size()) return value;
  } catch (const std::exception&) {  // no number: told below
  }
  throw UserError(fmt::format("--axial '{}': rotatable, face-centred or a number of steps", text));
}

doe::Design plan_of(const Options& options) {
  std::vector<doe::Factor> factors;
  for (const std::string& text : options.list("factor")) factors.push_back(doe::parse_factor(text));
  const std::string kind = options.text("KIND");
  const int centre_points = whole(options, "centre-points", 3);
  const std::uint64_t seed = options.seed("seed");
  const auto runs = [&options] {
    if (!options.has("runs")) throw UserError("--runs is missing: how many points shall the plan have?");
    return options.integer("runs");
  };
  if (kind == "two-level") return doe::two_level(factors, options.list("generators"), centre_points);
  if (options.has("generators")) throw UserError(fmt::format("--generators: a {} plan has none; leave the option out", kind));
  if (kind == "central-composite") return doe::central_composite(factors, axial_of(options, factors.size()), centre_points);
  if (kind == "latin-hypercube") return doe::latin_hypercube(factors, runs(), seed);
  if (kind == "sobol") return doe::sobol(factors, runs());
  throw UserError(fmt::format("'doe design {}' is no plan; {}", kind,
                              base::suggestion(kind, {"two-level", "central-composite", "latin-hypercube", "sobol"})));
}

int design(const Arguments& arguments) {
  Options options(
      "doe design KIND --factor NAME=LOW:HIGH … [-o PLAN.csv]",
      "Plans runs as a table in natural units. Add a column for each response and hand it to 'doe analyze'.",
      "millscope doe design two-level --factor A=0.3:0.7 --factor B=0.3:0.7 --factor C=0.3:0.7 --factor D=0.3:0.7 --generators D=A*B*C");
  options.positional("KIND", "two-level, central-composite, latin-hypercube or sobol");
  options.choices("KIND", {"two-level", "central-composite", "latin-hypercube", "sobol"});
  options.add()("factor,f", po::value<std::vector<std::string>>()->value_name("NAME=LOW:HIGH"),
                "what is varied (once for each); LOW and HIGH are coded -1 and +1, axial runs may lie beyond");
  options.add()("generators", po::value<std::vector<std::string>>()->value_name("D=A*B*C"),
                "a fraction of the two-level plan (may be repeated)");
  options.add()("centre-points", po::value<int>()->value_name("N"), "runs at the centre (default: 3)");
  options.add()("axial", po::value<std::string>()->value_name("STEPS"), "rotatable (default), face-centred or a number of steps");
  options.add()("runs", po::value<int>()->value_name("N"), "of a Latin hypercube or Sobol' plan");
  options.add()("seed", po::value<std::string>()->value_name("N")->default_value("1"), "of a Latin hypercube");
  options.add()("output,o", po::value<std::string>()->value_name("PLAN.csv"), "write the table (default: print it)");
  options.add()("force", "replace PLAN.csv");
  if (!options.parse(arguments)) return kDone;
  const doe::Design plan = plan_of(options);
  const std::string table = doe::plan_table(plan);
  if (!options.has("output")) {
    fmt::print("{}", table);
    return kDone;
  }
  const fs::path output = options.text("output");
  output::write_file(output, table, options.has("force"));
  fmt::print("{} runs in {}{}\n", plan.coded.rows(), output.string(), plan.resolution.empty() ? "" : ", resolution " + plan.resolution);
  return kDone;
}

constexpr Action kDoeActions[] = {
    {"analyze", "what planned runs tell: effects, surfaces, runs that stand out", analyze_plan},
    {"design", "plan runs", design},
};

}  // namespace

int design_of_experiments(const Arguments& arguments) {
  return call_action({"doe", "Design of experiments.", kDoeActions, "millscope doe analyze tests/doe/data/ccd_75.csv"}, arguments);
}

}  // namespace millscope::app
