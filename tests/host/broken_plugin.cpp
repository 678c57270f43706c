// One small body force, and by the macro VARIANT one thing wrong with it: what the loader must refuse.
#include <stdexcept>

#include "millscope/body_force_adapter.hpp"

#define GOOD 0
#define WRONG_MAGIC 1
#define WRONG_LIST_MAGIC 2
#define WRONG_SIZE 3
#define OLDER_ABI 4
#define NEWER_ABI 5
#define OTHER_HYPOTHESIS 6
#define WRONG_LAYOUT 7
#define WRONG_TABLE_SIZE 8
#define NO_SYMBOL 9
#define FUNCTION_SYMBOL 10
#define NULL_NAME 11
#define DEFAULT_OUTSIDE 12
#define PARAMETER_TWICE 13
#define NULL_FUNCTION 14
#define THROWS 15
#define THROWS_INT 16
#define LISTED_TWICE 17
#define HALF_GOOD 18
#define UNDEFINED_SYMBOL 19
#define UNKNOWN_KIND 20
#define WRONG_CHOICE 21
#define EMPTY_LIST 22
#define OLDER_LIST 23
#define BAD_NAME 24

void function_that_exists_nowhere();

namespace {

using namespace millscope;

constexpr Parameter kParameters[] = {
    number_parameter("strength", "N", VARIANT == DEFAULT_OUTSIDE ? 20.0 : 1.0, 0.0, 10.0, "Size of the force.", "A. Author 2000"),
    number_parameter(VARIANT == PARAMETER_TWICE ? "strength" : "other", "1", kRequired, -kUnbounded, kUnbounded, "Something else."),
    choice_parameter("mode", "push|pull", VARIANT == WRONG_CHOICE ? "turn" : "pull", "What it does."),
};

struct Push {
  explicit Push(const Parameters& values) : strength_(values.number("strength")) {
    if (VARIANT == THROWS) throw Refusal("strength 1 N is refused here; give 2 N");
    if (VARIANT == THROWS_INT) throw 7;
    if (VARIANT == UNDEFINED_SYMBOL) function_that_exists_nowhere();
  }
  void act(const Bead&, BeadForce& out) const { out.force.x = strength_; }
  double strength_;
};

constexpr BodyForceTable kTable = [] {
  BodyForceTable t = make_body_force_table<Push>();
  if (VARIANT == NULL_FUNCTION) t.evaluate = nullptr;
  return t;
}();

constexpr Hypothesis kHypotheses[] = {{"push", "something pushes", "F = strength", "A. Author 2000", "strength", 0, 0, 5}};

/// What the layout hash would be if Hypothesis had another member before its prior: the plugin of an SDK that was changed by hand.
struct OtherHypothesis {
  const char *name, *sentence, *equation, *citation, *parameter;
  double null_value, added, prior_low, prior_high;
  const char* excludes;
  std::uint32_t two_sided, reserved;
};

}  // namespace

template <>
struct millscope::Layout<OtherHypothesis> {
  using S = OtherHypothesis;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, name),     MILLSCOPE_MEMBER(S, sentence),  MILLSCOPE_MEMBER(S, equation),
                                       MILLSCOPE_MEMBER(S, citation), MILLSCOPE_MEMBER(S, parameter), MILLSCOPE_MEMBER(S, null_value),
                                       MILLSCOPE_MEMBER(S, added),    MILLSCOPE_MEMBER(S, prior_low), MILLSCOPE_MEMBER(S, prior_high),
                                       MILLSCOPE_MEMBER(S, excludes), MILLSCOPE_MEMBER(S, two_sided), MILLSCOPE_MEMBER(S, reserved)};
};

namespace {

constexpr std::uint64_t kOtherLayout = layout_hash(
    Kind::body_force, {}, StructList<Descriptor, Parameter, OtherHypothesis, Value, Values, Failure, BodyForceBatch, BodyForceTable>{});

constexpr Descriptor kPush = [] {
  Descriptor d = describe<Push>({.name = VARIANT == NULL_NAME  ? nullptr
                                         : VARIANT == BAD_NAME ? "Push Me"
                                                               : "push",
                                 .version = "1.2.3",
                                 .doc = "Pushes along x.",
                                 .equation = "F = strength",
                                 .parameters = kParameters,
                                 .hypotheses = kHypotheses});
  d.table = &kTable;
  if (VARIANT == WRONG_MAGIC) d.magic = 1;
  if (VARIANT == WRONG_SIZE) d.size -= 8;
  if (VARIANT == OLDER_ABI) d.abi_version = kAbiVersion - 1;
  if (VARIANT == NEWER_ABI) d.abi_version = kAbiVersion + 1;
  if (VARIANT == WRONG_LAYOUT) d.layout ^= 1;
  if (VARIANT == OTHER_HYPOTHESIS) d.layout = kOtherLayout;
  if (VARIANT == WRONG_TABLE_SIZE) d.table_size += 8;
  if (VARIANT == UNKNOWN_KIND) d.kind = 99;
  return d;
}();

constexpr Descriptor kSecond = [] {
  Descriptor d = kPush;
  d.name = VARIANT == LISTED_TWICE ? "push" : "second";
  if (VARIANT == HALF_GOOD) d.layout ^= 1;
  return d;
}();

}  // namespace

#if VARIANT == NO_SYMBOL
MILLSCOPE_EXPORT int something_else() { return kPush.name != nullptr && kSecond.name != nullptr; }
#elif VARIANT == FUNCTION_SYMBOL
MILLSCOPE_EXPORT int millscope_plugins() { return kPush.name != nullptr && kSecond.name != nullptr; }
#elif VARIANT == WRONG_LIST_MAGIC || VARIANT == EMPTY_LIST || VARIANT == OLDER_LIST
constinit const Descriptor* const kItems[] = {&kPush, &kSecond};
extern "C" {
extern __attribute__((visibility("default"))) const DescriptorList millscope_plugins;
constinit const DescriptorList millscope_plugins = {VARIANT == WRONG_LIST_MAGIC ? kMagic + 1 : kMagic, sizeof(DescriptorList),
                                                    VARIANT == OLDER_LIST ? kAbiVersion - 1 : kAbiVersion, VARIANT == EMPTY_LIST ? 0U : 2U,
                                                    kItems};
}
#else
MILLSCOPE_PLUGINS(&kPush, &kSecond)
#endif
