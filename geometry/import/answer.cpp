#include "geometry/import/answer.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <unordered_map>
#include <unordered_set>

#include "millscope/element.hpp"
#include "millscope/parameters.hpp"

namespace millscope::geometry {

namespace {

/// Kinds of block: an octet, then for `solid` a name (32-bit length) and triangles (64-bit count, nine doubles each); for `note` and
/// `refused` a sentence (32-bit length); `done` ends a complete answer.
enum class Block : char { solid = 'S', note = 'N', refused = 'R', done = 'D' };

void write_all(int pipe, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(pipe, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(1);  // the host is gone
    at += written;
    size -= as_size(written);
  }
}

void write_text(int pipe, const std::string& text) {
  const auto size = static_cast<std::uint32_t>(text.size());
  write_all(pipe, &size, sizeof size);
  write_all(pipe, text.data(), text.size());
}

void write_block(int pipe, Block block) { write_all(pipe, &block, 1); }

/// A name that a list of slots can hold: no bars, no control characters, not too long.
std::string slot_name(std::string name) {
  for (char& c : name) {
    if (c == '|' || static_cast<unsigned char>(c) < ' ') c = '_';
  }
  return name.substr(0, 100);
}

/// The slot of each solid: its name, another one where a shorter or cleaner name is taken; of several without a name each has a number,
/// but where they are many, as of an exporter that makes a solid of every face, they are one.
std::vector<std::string> slots_of(const std::vector<Solid>& solids) {
  constexpr std::size_t kManyNameless = 50, kMostSlots = 250;
  const auto nameless =
      static_cast<std::size_t>(std::count_if(solids.begin(), solids.end(), [](const Solid& s) { return s.name.empty(); }));
  const bool numbered = solids.size() > 1 && nameless <= kManyNameless;
  std::unordered_map<std::string, std::string> slot_of;  // name: slot
  std::unordered_set<std::string> taken;
  std::vector<std::string> slots;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const std::string name = !solids[i].name.empty() ? solids[i].name : numbered ? "solid_" + std::to_string(i + 1) : "all";
    const auto [at, fresh] = slot_of.try_emplace(name, slot_name(name));
    for (int k = 2; fresh && !taken.insert(at->second).second; ++k) at->second = slot_name(name).substr(0, 90) + "_" + std::to_string(k);
    if (taken.size() > kMostSlots)
      throw Refusal("has more than " + std::to_string(kMostSlots) +
                    " solids with names of their own: join those of one material and export again");
    slots.push_back(at->second);
  }
  return slots;
}

/// The child died on the way.
struct CutShort {};

/// Takes values off the front of the answer; asking for more than there is means that it is cut short.
class Reader {
 public:
  explicit Reader(const std::vector<char>& data) : at_(data.data()), left_(data.size()) {}

  void take(void* out, std::size_t size) {
    if (size > left_) throw CutShort();
    if (size > 0) std::memcpy(out, at_, size);
    at_ += size, left_ -= size;
  }
  std::string text() {
    std::uint32_t size = 0;
    take(&size, sizeof size);
    if (size > left_) throw CutShort();
    std::string s(size, '\0');
    take(s.data(), size);
    return s;
  }
  std::size_t left() const { return left_; }

 private:
  const char* at_;
  std::size_t left_;
};

void take_solid(Reader& reader, Soup& soup) {
  const std::string name = reader.text();
  std::uint64_t count = 0;
  reader.take(&count, sizeof count);
  if (count > reader.left() / (9 * sizeof(double))) throw CutShort();
  if (count == 0) return;
  const auto found = std::find(soup.names.begin(), soup.names.end(), name);  // of few: send_solids sends no more than kMostSlots
  const auto slot = static_cast<std::uint32_t>(found - soup.names.begin());
  if (found == soup.names.end()) soup.names.push_back(name);
  const std::size_t old = soup.corners.size();
  soup.corners.resize(old + 3 * count);
  reader.take(soup.corners.data() + old, count * 9 * sizeof(double));
  soup.slots.insert(soup.slots.end(), count, slot);
}

}  // namespace

void send_solids(int pipe, const Solids& file) {
  const std::vector<std::string> slots = slots_of(file.solids);
  for (std::size_t i = 0; i < file.solids.size(); ++i) {
    const Solid& s = file.solids[i];
    write_block(pipe, Block::solid);
    write_text(pipe, slots[i]);
    const std::uint64_t count = s.corners.size() / 9;
    write_all(pipe, &count, sizeof count);
    write_all(pipe, s.corners.data(), s.corners.size() * sizeof(double));
  }
  for (const std::string& note : file.notes) {
    write_block(pipe, Block::note);
    write_text(pipe, note);
  }
  write_block(pipe, Block::done);
}

void send_refusal(int pipe, const char* reason) {
  std::string line(reason);
  for (char& c : line) c = static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  write_block(pipe, Block::refused);
  write_text(pipe, line);
}

bool parse_answer(const std::vector<char>& answer, Soup& soup) {
  Reader reader(answer);
  try {
    while (reader.left() > 0) {
      Block block{};
      reader.take(&block, 1);
      if (block == Block::done) return true;
      if (block == Block::refused) throw Refusal(reader.text());
      if (block == Block::note) soup.notes.push_back(reader.text());
      if (block == Block::solid) take_solid(reader, soup);
    }
  } catch (const CutShort&) {
  }
  return false;
}

}  // namespace millscope::geometry
