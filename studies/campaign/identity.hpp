// What a simulation's result depends on, and its key in the cache.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kernel/base/program.hpp"
#include "kernel/config/case.hpp"
#include "kernel/host/registry.hpp"
#include "studies/campaign/campaign.hpp"

namespace millscope::campaign {

/// A file that a case names.
struct NamedFile {
  std::string path;   ///< absolute, as the resolved case has it
  std::string hash;   ///< of its content
  bool alone = true;  ///< needs no other file beside it, so that a copy elsewhere serves
};

/// A simulation that has been read.
struct Identity {
  std::string key;
  std::string donor;             ///< its key; "" without
  double develop_s = 0;          ///< s, with a donor
  base::ProgramParts program;    ///< what of program and plugins the key stands for
  std::string case_yaml;         ///< the resolved case; files by the paths of `files`
  std::vector<NamedFile> files;  ///< each once
  double work = 1;               ///< beads × simulated seconds: what its cost grows with
  double end_s = 0;              ///< s, time.end_s
  std::uint64_t memory = 0;      ///< predicted, bytes
  int cores = 1;                 ///< run.ranks where another engine plays it
};

/// Reads simulations; holds the plugins that explain their parameters.
class Identifier {
 public:
  explicit Identifier(const Options& options);
  /// Throws UserError when the case cannot be read. A donor whose case cannot be read is passed over for its own donor.
  Identity identify(const Simulation& simulation) const;

  struct Donor {
    std::shared_ptr<const Simulation> simulation;  ///< null: none
    std::string key;
    base::ProgramParts program;
  };
  /// The nearest donor whose case can be read. Each is read once.
  const Donor& donor_of(const Simulation& simulation) const;

 private:
  host::Registry registry_;
  mutable std::map<std::shared_ptr<const Simulation>, Donor> donors_;
};

/// A text that differs where the case, the content of a file that it names or the code of a plugin that it loads does; its name, threads
/// and checkpoints apart. Throws UserError for a file that cannot be read.
std::string content_of(const config::Case& c, const host::Registry& registry);

/// SHA-1 of bytes as 32 hexadecimal digits (a version 5 UUID).
std::string content_hash(const std::string& bytes);

/// The part of a key that stands for the case and the files that it names: the same whatever program computes it. All of a text that is no
/// key.
std::string case_of(const std::string& key);

/// Every `from` in `text` replaced by `to`.
std::string replaced(std::string text, const std::string& from, const std::string& to);

}  // namespace millscope::campaign
