// What is asked of the user for a new mill, in order, each with a default that follows from the answers before.
#pragma once

#include <functional>
#include <string>

#include "studies/new/mill.hpp"

namespace millscope::new_mill {

struct Question {
  std::string option;    ///< "diameter"
  std::string text;      ///< "inner diameter of the bare shell"
  std::string standard;  ///< the default as it would be typed
};

/// Gives the answer to a question: that of the command line, of a person, or the default. `take` throws UserError for an answer that
/// cannot be; whoever asks a person may ask again.
using Answer = std::function<void(const Question&, const std::function<void(const std::string&)>& take)>;

/// Asks for a whole mill. Throws UserError.
Mill ask_for_mill(const Answer& answer, const host::Registry& registry);

}  // namespace millscope::new_mill
