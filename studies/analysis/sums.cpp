#include "studies/analysis/sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <set>

#include "kernel/base/parallel.hpp"
#include "millscope/analyzer_adapter.hpp"

namespace millscope::analysis {
namespace {

using base::UserError;

std::vector<double*> pointers(const SumLayout::Part& part, double* row) {
  std::vector<double*> arrays;
  for (const std::size_t offset : part.arrays) arrays.push_back(row + part.begin + offset);
  return arrays;
}

ResultBlock span_of(const FrameBlock& block, std::size_t stretch) {
  ResultBlock span{0, 0, block.duration, static_cast<std::uint32_t>(stretch)};
  if (block.frame_count > 0) {
    span.start = block.time[0];
    span.end = block.time[block.frame_count - 1];
  }
  return span;
}

/// What finish hands over, copied.
struct Collector {
  const AnalyzerInstance& instance;
  std::vector<ResultArray> arrays;
  std::string fault;

  void add(const Result& r) {
    if (!fault.empty()) return;
    if (r.name == nullptr || *r.name == '\0' || r.rank > kMaxRank || r.values == nullptr) {
      fault = "gave a result without name or values, or with more than three dimensions";
      return;
    }
    ResultArray a;
    a.analyzer = instance.name;
    a.name = r.name;
    a.unit = r.unit == nullptr ? "" : r.unit;
    a.doc = r.doc == nullptr ? "" : r.doc;
    a.traits = r.traits;
    std::size_t size = 1;
    for (std::uint32_t d = 0; d < r.rank; ++d) {
      a.shape.push_back(r.shape[d]);
      a.axes.emplace_back(r.axis[d] == nullptr ? "" : r.axis[d]);
      size *= r.shape[d];
    }
    a.value.assign(r.values, r.values + size);
    arrays.push_back(std::move(a));
  }
};

void call_finish(const AnalyzerInstance& instance, const SumLayout::Part& part, const double* sums, ResultSink& sink) {
  std::vector<const double*> arrays;
  for (const std::size_t offset : part.arrays) arrays.push_back(sums + offset);
  Failure failure{};
  instance.object.check(instance.object.table().finish(instance.object.self(), arrays.data(), &sink, &failure), failure);
}

[[noreturn]] void blame(const AnalyzerInstance& instance, const std::string& fault) {
  throw UserError(
      fmt::format("analyzer '{}': {}; this is an error of its plugin: leave it out, or report it to its author", instance.name, fault));
}

/// Names once each; every axis is a result with the dimension's length, or one more.
void check_results(const AnalyzerInstance& instance, std::vector<ResultArray>& arrays) {
  std::set<std::string> names;
  for (const ResultArray& a : arrays) {
    if (!names.insert(a.name).second) blame(instance, fmt::format("gave the result '{}' twice", a.name));
  }
  for (const ResultArray& a : arrays) {
    for (std::size_t d = 0; d < a.axes.size(); ++d) {
      if (a.axes[d].empty()) continue;
      const auto axis = std::find_if(arrays.begin(), arrays.end(), [&](const ResultArray& other) { return other.name == a.axes[d]; });
      if (axis == arrays.end() || (axis->size() != a.shape[d] && axis->size() != a.shape[d] + 1)) {
        blame(instance, fmt::format("'{}' has the axis '{}', which is no result of that length", a.name, a.axes[d]));
      }
      axis->is_axis = true;
    }
  }
}

}  // namespace

SumLayout::SumLayout(const std::vector<AnalyzerInstance>& instances) {
  for (const AnalyzerInstance& instance : instances) {
    const ArrayInfo* items = nullptr;
    std::uint64_t count = 0;
    instance.object.table().arrays(instance.object.self(), &items, &count);
    Part part{size, 0, {}};
    for (std::uint64_t i = 0; i < count; ++i) {
      part.arrays.push_back(part.size);
      part.size += size_of(items[i]);
    }
    size += part.size;
    parts.push_back(std::move(part));
  }
}

SumTable sum_chunks(const FrameSource& source, const std::vector<AnalyzerInstance>& instances, const SumLayout& layout, std::size_t workers,
                    const Progress& progress) {
  const std::size_t count = source.chunk_count();
  SumTable table{std::vector<Row>(count), std::vector<ResultBlock>(count)};
  std::vector<std::unique_ptr<FrameSource::Scratch>> scratch(workers);
  std::size_t done = 0;
  std::mutex guard;
  base::for_each_item(count, workers, [&](std::size_t chunk, std::size_t worker) {
    if (!scratch[worker]) scratch[worker] = source.make_scratch();
    const FrameBlock& block = source.load(chunk, *scratch[worker]);
    table.rows[chunk].assign(layout.size, 0.0);
    for (std::size_t i = 0; i < instances.size(); ++i) {
      Failure failure{};
      const host::AnalyzerObject& object = instances[i].object;
      const std::vector<double*> arrays = pointers(layout.parts[i], table.rows[chunk].data());
      object.check(object.table().accumulate(object.self(), &block, arrays.data(), &failure), failure);
    }
    table.spans[chunk] = span_of(block, source.stretch(chunk));
    const std::lock_guard<std::mutex> hold(guard);
    if (progress) progress("reading", static_cast<double>(++done) / static_cast<double>(count));
  });
  return table;
}

SumTable merge_blocks(SumTable&& chunks, double least) {
  SumTable blocks;
  const std::size_t count = chunks.rows.size();
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin;
    double total = 0;
    for (; end < count && chunks.spans[end].stretch == chunks.spans[begin].stretch; ++end) total += chunks.spans[end].duration;
    const double parts = std::max(1.0, std::min(std::floor(total / std::max(least, 1e-300) + 1e-6), static_cast<double>(end - begin)));
    double before = 0;
    double block = -1;
    for (std::size_t c = begin; c < end; ++c) {
      const double middle = before + 0.5 * chunks.spans[c].duration;
      const double at = total > 0 ? std::min(parts - 1, std::floor(middle / total * parts)) : 0;
      before += chunks.spans[c].duration;
      if (at == block) {
        ResultBlock& span = blocks.spans.back();
        span.end = chunks.spans[c].end;
        span.duration += chunks.spans[c].duration;
        for (std::size_t i = 0; i < chunks.rows[c].size(); ++i) blocks.rows.back()[i] += chunks.rows[c][i];
      } else {
        blocks.rows.push_back(std::move(chunks.rows[c]));
        blocks.spans.push_back(chunks.spans[c]);
      }
      block = at;
      Row().swap(chunks.rows[c]);
    }
    begin = end;
  }
  return blocks;
}

std::vector<ResultArray> finish_arrays(const AnalyzerInstance& instance, const SumLayout::Part& part, const double* sums) {
  Collector collector{instance, {}, ""};
  ResultSink sink{&collector, [](void* host, const Result* r) { static_cast<Collector*>(host)->add(*r); }};
  call_finish(instance, part, sums, sink);
  if (!collector.fault.empty()) blame(instance, collector.fault);
  check_results(instance, collector.arrays);
  return std::move(collector.arrays);
}

void finish_values(const AnalyzerInstance& instance, const SumLayout::Part& part, const double* sums, const std::vector<ResultArray>& like,
                   std::span<double> values) {
  struct Filler {
    const std::vector<ResultArray>& like;
    std::span<double> values;
    std::size_t array = 0, at = 0;  // where the next result is expected
    bool differs = false;

    void add(const Result& r) {
      std::size_t size = 1;
      for (std::uint32_t d = 0; d < r.rank; ++d) size *= r.shape[d];
      // A result that was passed over does not exist for these sums: it stays undefined.
      std::size_t found = array, place = at;
      while (found < like.size() && like[found].name != r.name) place += like[found++].size();
      if (found == like.size()) return;  // one that the whole of the data does not give
      differs = differs || like[found].size() != size;
      if (differs) return;
      std::copy_n(r.values, size, values.begin() + static_cast<std::ptrdiff_t>(place));
      array = found + 1;
      at = place + size;
    }
  } filler{like, values};
  std::fill(values.begin(), values.end(), std::numeric_limits<double>::quiet_NaN());
  ResultSink sink{&filler, [](void* host, const Result* r) { static_cast<Filler*>(host)->add(*r); }};
  call_finish(instance, part, sums, sink);
  if (filler.differs) blame(instance, "gives results of other shapes for other sums: shapes must not depend on the data");
}

}  // namespace millscope::analysis
