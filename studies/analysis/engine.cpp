#include "studies/analysis/engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "kernel/base/parallel.hpp"
#include "studies/analysis/covariance.hpp"
#include "studies/analysis/resample.hpp"
#include "studies/analysis/resampled_sums.hpp"
#include "studies/analysis/sums.hpp"
#include "studies/analysis/times.hpp"

namespace millscope::analysis {
namespace {

using base::UserError;

constexpr std::size_t kMostChunks = 128, kWantedBlocks = 64, kSpeedBlocks = 20, kFewestChunks = 16;
constexpr double kMostSumBytes = 1e9, kMostDrawBytes = 4e9;

/// How finely the data may be cut so that the sums of all chunks fit into memory.
std::size_t most_chunks(const SumLayout& layout) {
  const double fit = kMostSumBytes / (8.0 * static_cast<double>(std::max<std::size_t>(1, layout.size)));
  return static_cast<std::size_t>(std::clamp(fit, static_cast<double>(kFewestChunks), static_cast<double>(kMostChunks)));
}

double total_duration(const SumTable& table) {
  double sum = 0;
  for (const ResultBlock& span : table.spans) sum += span.duration;
  return sum;
}

double block_length(const BlockLengths& lengths, double wished, double total) {
  return std::max({lengths.least, wished, total / static_cast<double>(kWantedBlocks),
                   std::min(lengths.wished, total / static_cast<double>(kSpeedBlocks))});
}

/// Sums of the blocks and the rule that cut them.
struct Blocks {
  SumTable table;
  BlockRule rule;
  std::vector<BasicSeries> series;  ///< one for each stretch
};

Blocks gather(FrameSource& source, const std::vector<AnalyzerInstance>& instances, const SumLayout& layout, const EngineOptions& options) {
  const bool one_bead = (source.context().has & kHasAllBeads) == 0;
  Blocks blocks;
  if (options.known) {
    blocks.rule.lengths = *options.known;
  } else {
    if (options.progress) options.progress("surveying", 0);
    blocks.series = source.survey();
    blocks.rule = block_rule(blocks.series, one_bead);
  }
  const double length = block_length(blocks.rule.lengths, options.block, source.duration());
  source.cut(length, most_chunks(layout));
  const std::size_t workers = base::worker_count(options.threads, source.chunk_count());
  blocks.table = merge_blocks(sum_chunks(source, instances, layout, workers, options.progress), length);
  return blocks;
}

/// Deviations of those values of an analyzer whose uncertainty is asked for: first the draws, then each block left out; [draws + blocks,
/// values].
struct Deviations {
  std::size_t values = 0;
  std::vector<float> numbers;
  float* row(std::size_t item) { return numbers.data() + item * values; }
};

struct Resampling {
  const std::vector<Row>& blocks;
  const std::vector<std::uint32_t>& counts;
  std::size_t draws;
  double scale;  ///< of a draw: √(n/(n − 1)), and for what neighbouring blocks have in common
  std::size_t items() const { return draws + blocks.size(); }
};

void add_part(const SumLayout::Part& part, const Row& row, double count, double* sums) {
  const double* from = row.data() + part.begin;
  for (std::size_t i = 0; i < part.size; ++i) sums[i] += count * from[i];
}

/// An array and where its values stand in what `finish_values` fills.
struct Wanted {
  ResultArray* array;
  std::size_t first;
};

Deviations resample(const AnalyzerInstance& instance, const SumLayout::Part& part, const std::vector<ResultArray>& arrays,
                    const std::vector<Wanted>& wanted, const Resampling& resampling, std::size_t workers) {
  std::size_t all = 0;
  for (const ResultArray& a : arrays) all += a.size();
  Deviations deviations;
  for (const Wanted& w : wanted) deviations.values += w.array->size();
  const double bytes = 4.0 * static_cast<double>(resampling.items()) * static_cast<double>(deviations.values);
  if (bytes > kMostDrawBytes) {
    throw UserError(fmt::format("analyzer '{}': {} values in {} resamples need {:.1f} GB; give it fewer cells, or lower resampling.draws",
                                instance.name, deviations.values, resampling.items(), bytes * 1e-9));
  }
  deviations.numbers.resize(resampling.items() * deviations.values);
  const ResampledSums sums(resampling.blocks, part, resampling.counts, resampling.draws);
  struct Scratch {
    std::vector<double> sums, values;
  };
  std::vector<Scratch> scratch(workers);
  base::for_each_item(sums.group_count(), workers, [&](std::size_t group, std::size_t worker) {
    Scratch& s = scratch[worker];
    s.sums.assign(ResampledSums::kGroup * part.size, 0.0);
    s.values.resize(all);
    const std::size_t first = group * ResampledSums::kGroup, last = std::min(first + ResampledSums::kGroup, resampling.items());
    sums.fill(group, s.sums.data());
    for (std::size_t item = first; item < last; ++item) {
      finish_values(instance, part, s.sums.data() + (item - first) * part.size, arrays, s.values);
      float* row = deviations.row(item);
      for (const Wanted& w : wanted) {
        for (std::size_t i = 0; i < w.array->size(); ++i) *row++ = static_cast<float>(s.values[w.first + i] - w.array->value[i]);
      }
    }
  });
  return deviations;
}

/// What a trait says of the range: the interval ends where it does. Of an amount that may as well be below 0, nothing is left.
void keep_range(ResultArray& array, std::size_t i, std::span<const float> draws) {
  double& value = array.value[i];
  if (array.has(kShare)) {
    const double most = array.unit == "%" ? 100 : 1;
    array.low[i] = std::isnan(array.low[i]) ? array.low[i] : std::clamp(array.low[i], std::min(0.0, value), most);
    array.high[i] = std::isnan(array.high[i]) ? array.high[i] : std::clamp(array.high[i], 0.0, std::max(most, value));
  }
  if (!array.has(kNotNegative) || std::isnan(value)) return;
  const auto out = std::count_if(draws.begin(), draws.end(), [&](float d) { return !(value + static_cast<double>(d) >= 0); });
  if (!array.has(kSpread) && static_cast<double>(out) > 0.05 * static_cast<double>(draws.size())) {
    value = array.sem[i] = array.low[i] = array.high[i] = std::numeric_limits<double>::quiet_NaN();
    array.flags[i] |= kOftenUndefined | kNoUncertainty;
  } else if (array.low[i] < 0) {
    array.low[i] = std::min(0.0, value);
  }
}

/// Where others of the array vary, one that is the same in every block (never visited, always 1) is not known exactly: the next block may
/// be another.
void doubt_the_same(ResultArray& array) {
  if (std::none_of(array.sem.begin(), array.sem.end(), [](double sem) { return sem > 0; })) return;
  for (std::size_t i = 0; i < array.size(); ++i) {
    if (array.sem[i] != 0) continue;
    array.sem[i] = array.low[i] = array.high[i] = std::numeric_limits<double>::quiet_NaN();
    array.flags[i] |= kNoUncertainty;
  }
}

/// Uncertainty of the values first … first + array.size() − 1 of the deviations.
void judge(ResultArray& array, std::size_t first, const Deviations& deviations, const Resampling& resampling,
           const std::vector<std::uint8_t>& follows) {
  const std::size_t size = array.size(), draws = resampling.draws, blocks = resampling.blocks.size();
  array.sem.resize(size);
  array.low.resize(size);
  array.high.resize(size);
  array.effective_blocks.resize(size);
  array.flags.resize(size);
  const bool keep = size <= kMostDrawnValues && blocks >= 2;
  if (keep) array.draws.resize(draws * size);
  std::vector<float> column(resampling.items());
  // What sets stretches of time against each other (a decay, what persists) feels neighbouring blocks alike because of their place in time;
  // that is no memory, and to widen for it would make errors four times too large.
  const bool by_place = array.has(kSpread) && array.has(kBookkeeping) && !array.has(kNotNegative);
  const std::vector<std::uint8_t> related = by_place ? std::vector<std::uint8_t>(blocks, 0) : follows;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t item = 0; item < column.size(); ++item) column[item] = deviations.numbers[item * deviations.values + first + i];
    const std::span<const float> all(column);
    if (array.has(kSpread)) {
      const std::vector<float> linear = influence_draws(all.subspan(draws), resampling.counts);
      std::copy(linear.begin(), linear.end(), column.begin());
    }
    const Uncertainty u = uncertainty(array.value[i], all.first(draws), all.subspan(draws), related);
    array.sem[i] = u.sem;
    array.low[i] = u.low;
    array.high[i] = u.high;
    array.effective_blocks[i] = u.effective_blocks;
    array.flags[i] = u.flags;
    keep_range(array, i, all.first(draws));
    if (!keep) continue;
    const double scale = u.sem > 0 ? resampling.scale : 0;
    for (std::size_t b = 0; b < draws; ++b) array.draws[b * size + i] = static_cast<float>(scale * column[b]);
  }
  doubt_the_same(array);
}

/// N_eff of the basic observables, and what neighbouring blocks have in common. z is slow and sets no blocks, and is not counted.
void look_at_memory(const Blocks& blocks, const std::vector<std::uint32_t>& counts, ResultMeta& meta) {
  if (meta.times.empty()) return;  // known beforehand
  double sum = 0, known = 0;
  for (std::size_t k = 0; k < meta.times.size(); ++k) {
    const BlockMemory memory = block_memory(blocks.series, k, meta.blocks, counts);
    meta.times[k].independent = memory.independent;
    if (meta.times[k].name != "z" && !std::isnan(memory.correlation)) sum += memory.correlation, ++known;
  }
  meta.lengths.correlation = known > 0 ? sum / known : 0;
}

std::vector<std::uint8_t> followers(const std::vector<ResultBlock>& spans) {
  std::vector<std::uint8_t> follows(spans.size(), 0);
  for (std::size_t i = 1; i < spans.size(); ++i) follows[i] = spans[i].stretch == spans[i - 1].stretch ? 1 : 0;
  return follows;
}

std::vector<std::string> notes_on(const ResultMeta& meta, const BlockRule& rule, double total) {
  std::vector<std::string> notes;
  const std::size_t blocks = meta.blocks.size();
  const bool one_frame = blocks == 1 && meta.context.start == meta.context.end;  // whose source says so
  if (blocks < 10 && !one_frame) {
    const double least = std::max(rule.lengths.least, meta.block_duration);
    notes.push_back(fmt::format(
        "only {} block{} of at least three autocorrelation times in {:.3g} s: {}; about {:.3g} s would give 10 blocks", blocks,
        blocks == 1 ? "" : "s", total, blocks < 2 ? "no uncertainty can be given" : "the intervals cannot be relied on", 10 * least));
  }
  for (const ObservableTime& t : rule.times) {
    if (t.sets_the_block || std::isnan(t.time) || 3 * t.time <= meta.block_duration) continue;
    notes.push_back(
        fmt::format("{} is remembered for {:.3g} s, longer than a third of a block ({:.3g} s): what depends on it rests on about {:.0f} "
                    "independent values and is widened only as far as the blocks show it",
                    t.name, t.time, meta.block_duration, t.effective));
  }
  return notes;
}

}  // namespace

ResultSet run_analyzers(FrameSource& source, const std::vector<AnalyzerInstance>& instances, const EngineOptions& options) {
  const SumLayout layout(instances);
  std::uint64_t fields = 0;
  for (const AnalyzerInstance& instance : instances) fields |= instance.object.table().needs;
  source.want(fields);
  const Blocks blocks = gather(source, instances, layout, options);
  ResultSet results;
  results.meta.context = source.context();
  // These point into the source, which the results outlive.
  results.meta.context.channel_count = results.meta.context.impact_pair_count = results.meta.context.impact_bin_count = 0;
  results.meta.context.channel_name = results.meta.context.impact_pair = nullptr;
  results.meta.context.impact_energy_edge = nullptr;
  results.meta.seed = options.seed;
  results.meta.draws = static_cast<std::uint32_t>(options.draws);
  results.meta.blocks = blocks.table.spans;
  results.meta.lengths = blocks.rule.lengths;
  results.meta.times = blocks.rule.times;
  const double total = total_duration(blocks.table);
  const std::size_t count = blocks.table.rows.size();
  results.meta.block_duration = count > 0 ? total / static_cast<double>(count) : 0;
  results.meta.notes = source.notes();
  for (std::string& note : notes_on(results.meta, blocks.rule, total)) results.meta.notes.push_back(std::move(note));

  const std::vector<std::uint32_t> counts = draw_counts(count, options.draws, options.seed);
  look_at_memory(blocks, counts, results.meta);
  const auto n = static_cast<double>(count);
  const std::vector<std::uint8_t> follows = followers(blocks.table.spans);
  const bool neighbours = std::find(follows.begin(), follows.end(), 1) != follows.end();  // of single beads each may be one block
  const double wider = neighbours ? widening(results.meta.lengths.correlation) : 1;
  const Resampling resampling{blocks.table.rows, counts, options.draws, count > 1 ? std::sqrt(n / (n - 1) * wider) : 0};
  const std::size_t workers = base::worker_count(options.threads, resampling.items());
  for (std::size_t k = 0; k < instances.size(); ++k) {
    if (options.progress) options.progress("resampling", static_cast<double>(k) / static_cast<double>(instances.size()));
    const SumLayout::Part& part = layout.parts[k];
    std::vector<double> sums(part.size, 0.0);
    for (const Row& row : blocks.table.rows) add_part(part, row, 1.0, sums.data());
    std::vector<ResultArray> arrays = finish_arrays(instances[k], part, sums.data());
    std::vector<Wanted> wanted;
    std::size_t first = 0;
    for (ResultArray& array : arrays) {
      if (!array.is_axis && (!options.uncertain || options.uncertain(array.analyzer, array.name))) wanted.push_back({&array, first});
      first += array.size();
    }
    if (!wanted.empty()) {
      const Deviations deviations = resample(instances[k], part, arrays, wanted, resampling, workers);
      first = 0;
      for (const Wanted& w : wanted) {
        judge(*w.array, first, deviations, resampling, follows);
        first += w.array->size();
      }
    }
    std::move(arrays.begin(), arrays.end(), std::back_inserter(results.arrays));
  }
  if (!options.uncertain) add_covariance(results);
  return results;
}

}  // namespace millscope::analysis
