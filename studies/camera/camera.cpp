#include "studies/camera/camera.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "kernel/base/hash.hpp"
#include "kernel/config/units.hpp"
#include "kernel/config/values.hpp"
#include "millscope/observation_adapter.hpp"

namespace millscope::camera {
namespace {

using base::UserError;
using config::Node;

/// Samples between two links of the chain.
struct Samples {
  std::vector<double> time, weight;
  std::array<std::vector<double>, 3> position;
  std::vector<std::uint32_t> visible;

  void resize(std::size_t n) {
    for (auto* v : {&time, &weight, &position[0], &position[1], &position[2]}) v->resize(n);
    visible.resize(n);
  }
  TrackView view() const {
    return {static_cast<std::int64_t>(time.size()),
            time.data(),
            {position[0].data(), position[1].data(), position[2].data()},
            weight.data(),
            visible.data()};
  }
};

Status give_room(void* host, std::int64_t count, TrackBuffer* out) {
  if (count < 0) return 1;
  Samples& samples = *static_cast<Samples*>(host);
  try {
    samples.resize(count);
  } catch (const std::exception&) {
    return 1;
  }
  *out = {count,
          samples.time.data(),
          {samples.position[0].data(), samples.position[1].data(), samples.position[2].data()},
          samples.weight.data(),
          samples.visible.data()};
  return 0;
}

std::uint64_t mixed(std::uint64_t seed, std::uint64_t with) { return Random(seed ^ Random(with).bits()).bits(); }

void check_samples(const CameraLink& link, const Samples& samples) {
  for (std::size_t i = 0; i < samples.time.size(); ++i) {
    const bool finite = std::isfinite(samples.time[i]) && std::isfinite(samples.position[0][i]) && std::isfinite(samples.position[1][i]) &&
                        std::isfinite(samples.position[2][i]);
    if (finite && (i == 0 || samples.time[i] > samples.time[i - 1])) continue;
    throw UserError(link.plugin.where(),
                    fmt::format("observation '{}' ({}) made sample {} with {}; mend the plugin or its values", link.name,
                                link.plugin.name(), i, finite ? "a time that does not increase" : "a value that is not finite"));
  }
}

Samples pass(const CameraLink& link, const Samples& in, TrackContext context) {
  context.seed = mixed(context.seed, base::Hash().add(link.name).value());
  Samples out;
  const TrackSink sink{&out, give_room};
  const TrackView view = in.view();
  Failure failure{};
  link.plugin.check(link.plugin.table().observe(link.plugin.self(), &view, &context, &sink, &failure), failure);
  check_samples(link, out);
  return out;
}

CameraLink make_link(const Node& node, const std::string& name, const host::Registry& registry) {
  const Node kind = node.at("kind", "the name of an observation plugin, e.g. noise");
  const host::Loaded& plugin = registry.find(Kind::observation, kind.text(), kind.where());
  const config::ResolvedValues values = config::resolve(*plugin.descriptor, node, Scope::instance);
  double span = 0;
  if (kind.text() == "location_blur") span = Parameters(values.view()).number("window");
  if (kind.text() == "sampling" && Parameters(values.view()).number("rate") > 0) span = 1 / Parameters(values.view()).number("rate");
  return {name, host::ObservationObject::create(plugin, values.view(), node.where()), span};
}

Camera camera_of(const Node& root, const host::Registry& registry) {
  root.expect({"schema_version", "name", "observations"});
  if (config::read_integer(root.at("schema_version", "1"), config::any_number()) != 1) {
    root.at("schema_version").fail("is not 1, the only version of camera files so far");
  }
  if (const auto name = root.find("name")) name->text();
  std::vector<CameraLink> links;
  const std::optional<Node> chain = root.has("observations") ? std::optional(root.at("observations")) : std::nullopt;
  if (!chain) root.fail("names no 'observations'; write what the camera does, e.g. noise: {kind: noise, white: [0.5, 0.5, 0.5, mm]}");
  for (const std::string& name : chain->keys()) links.push_back(make_link(chain->at(name), name, registry));
  root.finish();
  return Camera(std::move(links));
}

}  // namespace

Camera read_camera(const std::filesystem::path& file, const host::Registry& registry, const std::vector<std::string>& overrides) {
  return camera_of(config::load_document(file.string(), overrides), registry);
}

Camera parse_camera(const std::string& text, const std::string& name, const host::Registry& registry,
                    const std::vector<std::string>& overrides) {
  return camera_of(config::parse_document(text, name, overrides), registry);
}

recording::Run observe(const output::TrackSamples& track, const Camera& camera, const TrackContext& context) {
  Samples samples{track.time, std::vector<double>(track.size(), 1.0), track.position, std::vector<std::uint32_t>(track.size(), 1)};
  for (const CameraLink& link : camera.links()) samples = pass(link, samples, context);
  constexpr double kSpreadOfFullConfidence = 1e-3;  // m
  recording::Run run;
  bool judged = false;
  for (std::size_t i = 0; i < samples.time.size(); ++i) {
    if (samples.visible[i] == 0) continue;
    run.time.push_back(samples.time[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) run.position[axis].push_back(samples.position[axis][i]);
    run.spread.push_back(samples.weight[i] > 0 ? kSpreadOfFullConfidence / samples.weight[i] : 1.0);
    judged = judged || samples.weight[i] < 1.0;
  }
  if (!judged) run.spread.clear();
  run.report.rows = run.report.used = run.size();
  return run;
}

std::uint64_t bead_seed(std::uint64_t seed, std::int64_t id) { return mixed(seed, static_cast<std::uint64_t>(id) + 1); }

}  // namespace millscope::camera
