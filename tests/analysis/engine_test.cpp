#include "studies/analysis/engine.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/support.hpp"
#include "kernel/base/parallel.hpp"
#include "studies/analysis/times.hpp"

using namespace analysis_test;
using namespace millscope;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// One bead that follows given coordinates; two stretches, with the shared frames between chunks that the contract promises.
class MadeUp : public analysis::FrameSource {
 public:
  explicit MadeUp(std::uint64_t seed, std::size_t frames = 4000) {
    context_.has = kHasVelocity | kHasWallWork;
    context_.largest_id = 1;
    for (std::size_t k = 0; k < 2; ++k) {
      Stretch& s = stretches_[k];
      s.x = autoregressive(frames, 0.8, seed + k);
      s.y = autoregressive(frames, 0.8, seed + k + 100);
      for (std::size_t i = 0; i < frames; ++i) s.work.push_back(2.0 * 0.01 * static_cast<double>(i));
    }
    cut(0, 1);
  }
  const AnalyzerContext& context() const override { return context_; }
  std::size_t chunk_count() const override { return chunks_.size(); }
  std::size_t stretch(std::size_t chunk) const override { return chunks_[chunk].stretch; }
  std::string description() const override { return "made up"; }
  void want(std::uint64_t) override {}
  double duration() const override { return 0.01 * static_cast<double>(stretches_[0].x.size() + stretches_[1].x.size()); }
  std::unique_ptr<Scratch> make_scratch() const override { return std::make_unique<Buffers>(); }

  void cut(double duration, std::size_t most) override {
    chunks_.clear();
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t n = stretches_[k].x.size();
      double parts = static_cast<double>(std::max<std::size_t>(1, most / 2));
      if (duration > 0) parts = std::max(1.0, std::min(parts, std::floor(0.01 * static_cast<double>(n) / duration)));
      for (std::size_t p = 0; p < static_cast<std::size_t>(parts); ++p) {
        chunks_.push_back({k, p * n / static_cast<std::size_t>(parts), (p + 1) * n / static_cast<std::size_t>(parts)});
      }
    }
  }
  std::vector<analysis::BasicSeries> survey() const override {
    std::vector<analysis::BasicSeries> all(2);
    const auto scratch = make_scratch();
    for (std::size_t c = 0; c < chunks_.size(); ++c) all[chunks_[c].stretch].append(analysis::basics_of(load(c, *scratch)));
    return all;
  }
  const FrameBlock& load(std::size_t number, analysis::FrameSource::Scratch& scratch) const override {
    Buffers& b = static_cast<Buffers&>(scratch);
    const Chunk& chunk = chunks_[number];
    const Stretch& s = stretches_[chunk.stretch];
    const std::size_t lead = chunk.first > 0 ? 1 : 0, begin = chunk.first - lead, n = chunk.last - begin;
    b.time.clear();
    for (std::size_t i = begin; i < chunk.last; ++i) b.time.push_back(0.01 * static_cast<double>(i));
    b.weight.assign(n, 0.01);
    if (lead > 0) b.weight[0] = 0;
    b.zero.assign(n, 0.0);
    b.piece.assign(n, 0);
    b.id.assign(n, static_cast<std::int64_t>(chunk.stretch));
    b.first.resize(n + 1);
    for (std::size_t i = 0; i <= n; ++i) b.first[i] = static_cast<std::int64_t>(i);
    b.block = {};
    b.block.has = context_.has;
    b.block.duration = 0.01 * static_cast<double>(chunk.last - chunk.first);
    b.block.frame_count = static_cast<std::int64_t>(n);
    b.block.time = b.time.data();
    b.block.piece = b.piece.data();
    b.block.first = b.first.data();
    b.block.weight = b.weight.data();
    b.block.id = b.id.data();
    b.block.position[0] = s.x.data() + begin;
    b.block.position[1] = s.y.data() + begin;
    b.block.position[2] = b.zero.data();
    for (auto& v : b.block.velocity) v = b.zero.data();
    b.block.wall_work = s.work.data() + begin;
    return b.block;
  }

 private:
  struct Buffers : analysis::FrameSource::Scratch {
    FrameBlock block{};
    std::vector<double> time, weight, zero;
    std::vector<std::int32_t> piece;
    std::vector<std::int64_t> id, first;
  };
  struct Stretch {
    std::vector<double> x, y, work;
  };
  struct Chunk {
    std::size_t stretch, first, last;
  };
  AnalyzerContext context_{};
  Stretch stretches_[2];
  std::vector<Chunk> chunks_;
};

/// Means of x and y, a histogram of x, and the power of the walls.
struct Means {
  static constexpr std::uint64_t kNeeds = kHasVelocity;
  Means(const Parameters&, const AnalyzerContext&) {}
  std::vector<ArrayInfo> arrays() const { return {additive("sums", "mixed", {5}), additive("bins", "s", {4})}; }
  void accumulate(const FrameBlock& b, double* const* sums) const {
    for (std::int64_t i = 0; i < b.frame_count; ++i) {
      sums[0][0] += b.weight[i];
      sums[0][1] += b.weight[i] * b.position[0][i];
      sums[0][2] += b.weight[i] * b.position[1][i];
      if (i > 0) sums[0][3] += b.wall_work[i] - b.wall_work[i - 1], sums[0][4] += b.time[i] - b.time[i - 1];
      sums[1][std::clamp(static_cast<int>(b.position[0][i] + 2), 0, 3)] += b.weight[i];
    }
  }
  void finish(const double* const* s, Results& r) const {
    const double edges[] = {-2, -1, 0, 1, 2};
    double share[4];
    for (int k = 0; k < 4; ++k) share[k] = s[1][k] / s[0][0];
    r.add("edges", "m", edges, {5}, "Edges.");
    r.add("mean_x", "m", s[0][1] / s[0][0], "Mean x.");
    r.add("mean_y", "m", s[0][2] / s[0][0], "Mean y.");
    r.add("seconds", "s", s[0][0], "Time.");
    r.add("power", "W", s[0][3] / s[0][4], "Power.");
    r.add("share", "1", share, {4}, "Shares.", {"edges"});
  }
};

/// Twice the mean of x; refuses its axis, or gives a result only sometimes, when told so by its name.
struct Twice {
  static constexpr std::uint64_t kNeeds = 0;
  Twice(const Parameters&, const AnalyzerContext&) {}
  std::vector<ArrayInfo> arrays() const { return {additive("sums", "mixed", {2})}; }
  void accumulate(const FrameBlock& b, double* const* sums) const {
    for (std::int64_t i = 0; i < b.frame_count; ++i) {
      sums[0][0] += b.weight[i];
      sums[0][1] += 2 * b.weight[i] * b.position[0][i];
    }
  }
  void finish(const double* const* s, Results& r) const { r.add("twice_x", "m", s[0][1] / s[0][0], "Twice the mean x."); }
};

struct WrongAxis : Twice {
  using Twice::Twice;
  void finish(const double* const* s, Results& r) const { r.add("row", "m", s[0], {2}, "A row.", {"nowhere"}); }
};

struct Sometimes : Twice {
  using Twice::Twice;
  void finish(const double* const* s, Results& r) const {
    if (s[0][1] > 0) r.add("positive", "m", s[0][1], "Only where positive.");
    r.add("always", "s", s[0][0], "Time.");
  }
};

/// Results of every trait.
struct Ranges : Means {
  using Means::Means;
  void accumulate(const FrameBlock& b, double* const* sums) const {
    for (std::int64_t i = 0; i < b.frame_count; ++i) {
      const double x = b.position[0][i];
      sums[0][0] += b.weight[i];
      sums[0][1] += b.weight[i] * x;
      sums[1][1] += x < 0 ? b.weight[i] : 0;
      sums[1][3] += x > 2.3 ? b.weight[i] : 0;
    }
  }
  void finish(const double* const* s, Results& r) const {
    const double all = s[0][0];
    const double share[] = {s[1][1] / all, 0, 1, s[1][3] / all};  // the second was never seen, the third always
    const double constant[] = {1, 2};
    r.add("share", "1", share, {4}, "Shares.", {}, kShare);
    r.add("rare", "%", 100 * s[1][3] / all, "A share.", kShare | kOdd);
    r.add("rare_without", "%", 100 * s[1][3] / all, "The same without its range.");
    r.add("seconds", "s", all, "Time.", kBookkeeping | kNotNegative);
    r.add("perhaps_negative", "1", s[0][1] / all, "A mean about 0, called an amount.", kNotNegative);
    r.add("constant", "1", constant, {2}, "Exact.");
  }
};

struct Refuses : Twice {
  using Twice::Twice;
  void accumulate(const FrameBlock&, double* const*) const { throw Refusal("the beads are of the wrong colour; paint them"); }
};

analysis::EngineOptions with_threads(int threads) {
  analysis::EngineOptions options;
  options.threads = threads;
  return options;
}

std::vector<analysis::AnalyzerInstance> both(const AnalyzerContext& context) {
  std::vector<analysis::AnalyzerInstance> instances;
  instances.push_back(local_instance<Means>("means", context));
  instances.push_back(local_instance<Twice>("twice", context));
  return instances;
}

std::size_t entry(const analysis::ResultSet& r, const std::string& name) {
  for (std::size_t i = 0; i < r.covariance_entries.size(); ++i) {
    if (analysis::entry_name(r, r.covariance_entries[i]) == name) return i;
  }
  FAIL("no entry " << name);
  return 0;
}

}  // namespace

TEST_CASE("the number of threads changes no bit of the results") {
  MadeUp source(1);
  const std::vector<analysis::AnalyzerInstance> instances = both(source.context());
  const analysis::ResultSet one = analysis::run_analyzers(source, instances, with_threads(1));
  const analysis::ResultSet four = analysis::run_analyzers(source, instances, with_threads(4));
  REQUIRE(one.arrays.size() == four.arrays.size());
  for (std::size_t i = 0; i < one.arrays.size(); ++i) {
    CHECK(one.arrays[i].value == four.arrays[i].value);
    CHECK(one.arrays[i].sem == four.arrays[i].sem);
    CHECK(one.arrays[i].draws == four.arrays[i].draws);
  }
  CHECK(one.covariance == four.covariance);
}

TEST_CASE("what alone is asked for has the uncertainty that it has among all, to the bit") {
  MadeUp source(1);
  const std::vector<analysis::AnalyzerInstance> instances = both(source.context());
  const analysis::ResultSet all = analysis::run_analyzers(source, instances, with_threads(1));
  analysis::EngineOptions options = with_threads(2);
  options.uncertain = [](const std::string&, const std::string& result) { return result == "mean_y" || result == "share"; };
  const analysis::ResultSet some = analysis::run_analyzers(source, instances, options);
  REQUIRE(some.arrays.size() == all.arrays.size());
  for (std::size_t i = 0; i < all.arrays.size(); ++i) {
    const analysis::ResultArray &a = all.arrays[i], &b = some.arrays[i];
    INFO(a.name);
    CHECK(b.value == a.value);
    const bool asked = options.uncertain(a.analyzer, a.name);
    CHECK(b.sem == (asked ? a.sem : std::vector<double>()));
    CHECK(b.draws == (asked ? a.draws : std::vector<float>()));
    CHECK(b.effective_blocks == (asked ? a.effective_blocks : std::vector<double>()));
  }
  CHECK(!all.covariance.empty());
  CHECK(some.covariance.empty());
}

TEST_CASE("blocks join without loss and stay within their stretch") {
  MadeUp source(2);
  const analysis::ResultSet r = analysis::run_analyzers(source, both(source.context()), with_threads(2));
  CHECK_THAT(r.find("means", "seconds")->value[0], WithinRel(80.0, 1e-12));
  CHECK_THAT(r.find("means", "power")->value[0], WithinRel(2.0, 1e-9));  // work is lost where frames are not shared
  CHECK(r.meta.blocks.size() >= 40);
  CHECK(r.meta.blocks.size() <= 64);
  // N_eff = n (1 − φ)/(1 + φ) of 8000 values with the memory φ = 0.8.
  CHECK_THAT(r.meta.times[0].independent, WithinRel(889, 0.5));
  for (const analysis::ResultBlock& b : r.meta.blocks) CHECK(b.duration >= 3 * 0.045);
  CHECK(r.meta.blocks.front().stretch == 0);
  CHECK(r.meta.blocks.back().stretch == 1);
  const analysis::ResultArray& edges = *r.find("means", "edges");
  CHECK(edges.is_axis);
  CHECK(edges.sem.empty());
  CHECK(r.axis(*r.find("means", "share"), 0) == &edges);
}

TEST_CASE("results of one run have a joint covariance") {
  MadeUp source(3);
  const analysis::ResultSet r = analysis::run_analyzers(source, both(source.context()), with_threads(2));
  const std::size_t n = r.covariance_entries.size();
  CHECK(n == 4 + 4 + 1);  // mean_x, mean_y, seconds, power, share[4], twice_x
  const auto at = [&](std::size_t i, std::size_t j) { return r.covariance[i * n + j]; };
  const std::size_t x = entry(r, "means.mean_x"), y = entry(r, "means.mean_y"), twice = entry(r, "twice.twice_x");
  // All are widened by the mean memory, sem by its own.
  const double own = r.find("means", "mean_x")->sem[0], memory = std::sqrt(at(x, x)) / own;
  CHECK_THAT(memory, WithinAbs(1, 0.3));
  CHECK_THAT(at(x, twice), WithinRel(2 * at(x, x), 1e-4));
  CHECK_THAT(at(x, y) / std::sqrt(at(x, x) * at(y, y)), WithinAbs(0, 0.45));
  // Shares sum to one: their covariances sum to zero.
  double sum = 0, scale = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const double c = at(entry(r, "means.share[" + std::to_string(i) + "]"), entry(r, "means.share[" + std::to_string(j) + "]"));
      sum += c;
      scale += std::fabs(c);
    }
  }
  CHECK(std::fabs(sum) < 1e-5 * scale);
  CHECK(r.covariance_rank >= 5);
  CHECK(r.covariance_rank <= n);
}

TEST_CASE("intervals of a whole analysis hold with 90 %") {
  int hits = 0;
  constexpr int kTrials = 120;
  for (int trial = 0; trial < kTrials; ++trial) {
    MadeUp source(1000 + 7 * static_cast<std::uint64_t>(trial), 1500);
    std::vector<analysis::AnalyzerInstance> instances;
    instances.push_back(local_instance<Means>("means", source.context()));
    const analysis::ResultSet r = analysis::run_analyzers(source, instances, with_threads(1));
    for (const char* name : {"mean_x", "mean_y"}) {
      const analysis::ResultArray& a = *r.find("means", name);
      hits += a.low[0] <= 0 && a.high[0] >= 0 ? 1 : 0;
    }
  }
  const double coverage = hits / (2.0 * kTrials);
  CHECK(coverage >= 0.85);
  CHECK(coverage <= 0.95);
}

TEST_CASE("what never changed among what varies has no uncertainty, and intervals keep to their range") {
  MadeUp source(9, 400);
  std::vector<analysis::AnalyzerInstance> instances;
  instances.push_back(local_instance<Ranges>("ranges", source.context()));
  analysis::EngineOptions options = with_threads(1);
  options.block = 1.9;  // four blocks: wide intervals
  const analysis::ResultSet r = analysis::run_analyzers(source, instances, options);
  const analysis::ResultArray& share = *r.find("ranges", "share");
  CHECK(share.traits == kShare);
  CHECK(r.find("ranges", "seconds")->traits == (kBookkeeping | kNotNegative));
  for (const std::size_t k : {1, 2}) {
    CHECK((share.flags[k] & analysis::kNoUncertainty) != 0);
    CHECK(std::isnan(share.sem[k]));
    CHECK(std::isnan(share.low[k]));
  }
  for (const std::size_t k : {0, 3}) CHECK((share.flags[k] & analysis::kNoUncertainty) == 0);
  // Where all of a result is the same it is exact.
  CHECK(r.find("ranges", "constant")->sem == std::vector<double>{0, 0});
  for (const std::uint8_t flags : r.find("ranges", "constant")->flags) CHECK((flags & analysis::kNoUncertainty) == 0);
  CHECK(std::isnan(r.find("ranges", "perhaps_negative")->value[0]));
  CHECK((r.find("ranges", "perhaps_negative")->flags[0] & analysis::kOftenUndefined) != 0);
  CHECK(r.find("ranges", "rare_without")->low[0] < 0);
  CHECK(r.find("ranges", "rare")->low[0] == 0);
  CHECK(r.find("ranges", "rare")->high[0] == r.find("ranges", "rare_without")->high[0]);
}

TEST_CASE("a plugin that errs is named, one that gives a result only sometimes is endured") {
  MadeUp source(4);
  const auto alone = [&](analysis::AnalyzerInstance instance) {
    std::vector<analysis::AnalyzerInstance> instances;
    instances.push_back(std::move(instance));
    return analysis::run_analyzers(source, instances, with_threads(2));
  };
  CHECK_THAT(refusal([&] { alone(local_instance<WrongAxis>("wrong", source.context())); }),
             Contains("'wrong'") && Contains("axis 'nowhere'"));
  CHECK_THAT(refusal([&] { alone(local_instance<Refuses>("no", source.context())); }), Contains("wrong colour"));
  const analysis::ResultSet r = alone(local_instance<Sometimes>("some", source.context()));
  CHECK(r.find("some", "always") != nullptr);
  CHECK_THAT(r.find("some", "always")->value[0], WithinRel(80.0, 1e-9));
}

TEST_CASE("a span shorter than two blocks has results without uncertainty, and says so") {
  MadeUp source(5, 10);
  const analysis::ResultSet r = analysis::run_analyzers(source, both(source.context()), with_threads(1));
  CHECK(std::isfinite(r.find("means", "mean_x")->value[0]));
  REQUIRE_FALSE(r.meta.notes.empty());
  CHECK_THAT(r.meta.notes.front(), Contains("blocks of at least three autocorrelation times"));
  CHECK((r.find("means", "mean_x")->flags[0] & analysis::kFewBlocks) != 0);
}

TEST_CASE("analyzers that were read once are created without their document, by several threads") {
  const AnalyzerContext context = [] {
    AnalyzerContext c{};
    c.has = kHasVelocity | kHasOmega;
    c.mill_radius = 0.1, c.gravity = 9.81, c.omega = -2;
    return c;
  }();
  std::vector<analysis::AskedAnalyzer> asked;
  {
    const config::Node settings = config::parse_document("analyzers:\n  fine: {kind: slip}\n  power: {}\n", "a.yaml");
    asked = analysis::read_analyzers(settings, true, {}, testing::registry());
  }
  REQUIRE(asked.size() == 2);
  CHECK(asked[0].name == "fine");
  CHECK(asked[0].where.line == 2);
  std::vector<std::size_t> created(16);
  base::for_each_item(created.size(), 4,
                      [&](std::size_t i, std::size_t) { created[i] = analysis::create_analyzers(asked, context).instances.size(); });
  CHECK(created == std::vector<std::size_t>(16, 2));
  AnalyzerContext blind = context;
  blind.has = 0;
  CHECK_THAT(refusal([&] { analysis::create_analyzers(asked, blind); }), Catch::Contains("a.yaml:2: analyzer 'fine' needs"));
}
