#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <functional>
#include <string>

#include "kernel/output/terminal.hpp"

using namespace millscope::output;

namespace {

/// What `body` writes to stderr where that is a terminal of so many columns.
std::string on_terminal(unsigned short columns, const std::function<void()>& body) {
  int master = -1, slave = -1;
  const struct winsize size { 24, columns, 0, 0 };
  REQUIRE(::openpty(&master, &slave, nullptr, nullptr, &size) == 0);
  const int kept = ::dup(STDERR_FILENO);
  ::dup2(slave, STDERR_FILENO);
  body();
  ::dup2(kept, STDERR_FILENO);
  std::string text;
  struct pollfd ready {
    master, POLLIN, 0
  };
  for (char bytes[256]; ::poll(&ready, 1, 0) == 1 && (ready.revents & POLLIN) != 0;) {
    const ssize_t count = ::read(master, bytes, sizeof bytes);
    if (count <= 0) break;
    text.append(bytes, static_cast<std::size_t>(count));
  }
  for (const int descriptor : {kept, slave, master}) ::close(descriptor);
  return text;
}

}  // namespace

TEST_CASE("a duration is told to the second, with hours where there are any") {
  CHECK(duration_text(0) == "0:00");
  CHECK(duration_text(9.4) == "0:09");
  CHECK(duration_text(59.6) == "1:00");
  CHECK(duration_text(245) == "4:05");
  CHECK(duration_text(3599.4) == "59:59");
  CHECK(duration_text(3599.5) == "1:00:00");
  CHECK(duration_text(90061) == "25:01:01");
}

TEST_CASE("a line is drawn over the one before and cleared in the end") {
  const std::string text = on_terminal(80, [] {
    TerminalLine line;
    line.draw("one");
    line.draw("two");
  });
  CHECK(text == "\r\033[Kone\r\033[Ktwo\r\033[K");
}

TEST_CASE("what was not drawn is not cleared") {
  CHECK(on_terminal(80, [] { TerminalLine line; }).empty());
  const std::string text = on_terminal(80, [] {
    TerminalLine line;
    line.draw("one");
    line.clear();
    line.clear();
  });
  CHECK(text == "\r\033[Kone\r\033[K");
}

TEST_CASE("a line that the terminal has no room for is cut, so that it does not wrap") {
  const auto drawn = [](unsigned short columns) { return on_terminal(columns, [] { TerminalLine().draw("0123456789"); }); };
  CHECK(drawn(11) == "\r\033[K0123456789\r\033[K");
  CHECK(drawn(10) == "\r\033[K012345678\r\033[K");
  CHECK(drawn(4) == "\r\033[K012\r\033[K");
  CHECK(drawn(0) == "\r\033[K0123456789\r\033[K");  // the width is not known
}
