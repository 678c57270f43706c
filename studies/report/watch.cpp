#include "studies/report/watch.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <stdexcept>

#include "studies/report/one_section.hpp"
#include "studies/report/packed.hpp"
#include "studies/report/report.hpp"

namespace millscope::report {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
namespace fs = std::filesystem;
using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr seconds kPatience{10};  ///< with a client that says nothing
constexpr seconds kFresh{2};      ///< so long the same document is given again

/// What is served: the document, made anew when it is older than kFresh.
class Content {
 public:
  Content(fs::path out, const host::Registry& registry, const SectionOptions& options)
      : out_(std::move(out)), registry_(registry), options_(options) {}

  const Json& document() {
    if (made_ && steady_clock::now() - *made_ < kFresh) return document_;
    std::vector<Json> sections;
    try {
      sections = sections_of(out_, registry_, options_);
    } catch (const base::UserError&) {
      // Before the first file is there, or while one is being renamed, what was seen last is shown.
      if (made_) return document_;
    }
    document_ = document_of(out_.lexically_normal().string(), sections, true);
    made_ = steady_clock::now();
    return document_;
  }

 private:
  fs::path out_;
  const host::Registry& registry_;
  SectionOptions options_;
  Json document_;
  std::optional<steady_clock::time_point> made_;
};

/// Takes the same time whatever is wrong in `given`.
bool is_same(std::string_view given, std::string_view token) {
  if (given.size() != token.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < token.size(); ++i) different |= static_cast<unsigned>(given[i] ^ token[i]);
  return different == 0;
}

Response answer(const Request& request, const std::string& token, Content& content) {
  const std::string target(request.target());
  const std::size_t mark = std::min(target.find('?'), target.size());
  const std::string place = target.substr(0, mark), query = target.substr(mark);
  Response response{http::status::ok, request.version()};
  response.set(http::field::cache_control, "no-store");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  response.keep_alive(false);
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    response.result(http::status::method_not_allowed);
    response.body() = "only GET\n";
  } else if (!is_same(query, "?token=" + token)) {
    response.result(http::status::forbidden);
    response.body() = "the address lacks the token that millscope printed\n";
  } else if (place == "/") {
    response.set(http::field::content_type, "text/html; charset=utf-8");
    response.body() = page_of(content.document());
  } else if (place == "/data.json") {
    response.set(http::field::content_type, "application/json");
    response.body() = content.document().dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  } else {
    response.result(http::status::not_found);
    response.body() = "there is nothing here\n";
  }
  response.content_length(response.body().size());
  if (request.method() == http::verb::head) response.body().clear();
  return response;
}

asio::awaitable<void> serve(boost::beast::tcp_stream stream, const std::string& token, Content& content) {
  try {
    boost::beast::flat_buffer buffer;
    Request request;
    stream.expires_after(kPatience);
    co_await http::async_read(stream, buffer, request, asio::use_awaitable);
    const Response response = answer(request, token, content);
    stream.expires_after(kPatience);
    co_await http::async_write(stream, response, asio::use_awaitable);
    stream.socket().shutdown(asio::ip::tcp::socket::shutdown_send);
  } catch (const boost::system::system_error&) {
    // A client that goes away or talks nonsense is its own loss.
  }
}

asio::awaitable<void> accept(asio::ip::tcp::acceptor& acceptor, const std::string& token, Content& content) {
  for (;;) {
    boost::beast::tcp_stream stream(co_await acceptor.async_accept(asio::use_awaitable));
    asio::co_spawn(acceptor.get_executor(), serve(std::move(stream), token, content), asio::detached);
  }
}

asio::awaitable<void> until_over(asio::io_context& io, const std::function<bool()>& goes_on) {
  asio::steady_timer timer(io);
  while (goes_on()) {
    timer.expires_after(seconds(1));
    co_await timer.async_wait(asio::use_awaitable);
  }
  io.stop();
}

}  // namespace

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("the system gives no random numbers");
  std::string text;
  for (const unsigned char b : bytes) text += fmt::format("{:02x}", b);
  return text;
}

bool is_going_on(const fs::path& out) {
  if (state_of(out, "summary.json") == State::running) return true;
  std::error_code none;
  for (const char* below : {"", "cache"}) {
    for (const fs::directory_entry& entry : fs::directory_iterator(out / below, none)) {
      if (!entry.is_directory(none)) continue;
      if (state_of(entry.path(), "") == State::running || state_of(entry.path() / "run", "") == State::running) return true;
    }
  }
  return false;
}

void watch(const fs::path& out, const host::Registry& registry, const WatchOptions& options) {
  asio::io_context io(1);
  asio::ip::tcp::acceptor acceptor(io);
  try {
    acceptor.open(asio::ip::tcp::v4());
    acceptor.set_option(asio::ip::tcp::acceptor::reuse_address(true));
    acceptor.bind({asio::ip::address_v4::loopback(), options.port});
    acceptor.listen();
  } catch (const boost::system::system_error& e) {
    throw base::UserError(fmt::format("--port {}: cannot be opened: {}; leave --port out to take any free one", options.port, e.what()));
  }
  const std::string token = random_token();
  Content content(out, registry, options.sections);
  asio::co_spawn(io, accept(acceptor, token, content), asio::detached);
  asio::co_spawn(io, until_over(io, options.goes_on), asio::detached);
  if (options.say) options.say(fmt::format("http://127.0.0.1:{}/?token={}", acceptor.local_endpoint().port(), token));
  io.run();
}

}  // namespace millscope::report
