// Who holds a simulation, and who no longer does.
#include "studies/campaign/lock.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "studies/campaign/cache.hpp"
#include "tests/campaign/helpers.hpp"

namespace millscope::campaign::test {
namespace {

void age(const fs::path& file, long seconds) {
  const timespec past{std::time(nullptr) - seconds, 0};
  const timespec both[2] = {past, past};
  REQUIRE(::utimensat(AT_FDCWD, file.c_str(), both, 0) == 0);
}

}  // namespace

TEST_CASE("a lock is held once, says by whom, and goes with its holder") {
  const Folder folder;
  const fs::path file = folder.path() / "lock";
  auto lock = Lock::try_take(folder.path(), file);
  REQUIRE(lock);
  CHECK_THAT(base::text_of(file), Catch::Contains(host_name()) && Catch::Contains(std::to_string(::getpid())));
  CHECK_FALSE(Lock::try_take(folder.path(), file));
  lock.reset();
  CHECK_FALSE(fs::exists(file));
  CHECK(Lock::try_take(folder.path(), file));
}

TEST_CASE("the lock of a dead process is taken over") {
  const Folder folder;
  const fs::path file = folder.path() / "lock";
  const pid_t child = ::fork();
  if (child == 0) {
    const bool taken = Lock::try_take(folder.path(), file).release() != nullptr;  // dies with it, as kill -9 would have it
    ::_exit(taken ? 0 : 1);
  }
  int status = 1;
  siginfo_t info{};
  REQUIRE(::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOWAIT) == 0);
  REQUIRE(fs::exists(file));
  CHECK(Lock::try_take(folder.path(), file));  // dead, not even reaped
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(status == 0);
}

TEST_CASE("a number that another process has got meanwhile is no sign of life") {
  const Folder folder;
  const fs::path file = folder.path() / "lock";
  write(file, "{\"host\": \"" + host_name() + "\", \"process\": " + std::to_string(::getppid()) + ", \"birth\": \"1\"}\n");
  CHECK(Lock::try_take(folder.path(), file));
}

TEST_CASE("another machine's lock holds as long as it is touched") {
  const Folder folder;
  const fs::path file = folder.path() / "lock";
  write(file, "{\"host\": \"elsewhere.example\", \"process\": 1, \"birth\": \"1\"}\n");
  CHECK_FALSE(Lock::try_take(folder.path(), file));
  age(file, 60);
  CHECK_FALSE(Lock::try_take(folder.path(), file));
  age(file, 300);
  CHECK(Lock::try_take(folder.path(), file));
}

TEST_CASE("a lock that was lost to another is left alone") {
  const Folder folder;
  const fs::path file = folder.path() / "lock";
  auto lock = Lock::try_take(folder.path(), file);
  REQUIRE(lock);
  write(file, "another's");
  lock.reset();
  CHECK(base::text_of(file) == "another's");
}

}  // namespace millscope::campaign::test
