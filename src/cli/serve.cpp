#include "cli/serve.h"

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <charconv>
#include <chrono>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string_view>

#include "cli/desk_room.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;
using std::chrono::seconds;

constexpr std::uint64_t largest_request = std::uint64_t{1} << 31;  // bytes
constexpr auto most_time = seconds(120);  // for a request to come in, or an answer to go out

/// 128 bits from the system's source of randomness.
std::string random_word() {
  std::random_device device;
  std::string out;
  for (int k = 0; k < 32; ++k) out += "0123456789abcdef"[device() & 15];
  return out;
}

/// Takes as long for any two texts of the same length.
bool same(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[k] ^ b[k]));
  return difference == 0;
}

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

/// "/call?page=a&call=3" in its parts.
struct Target {
  explicit Target(std::string_view text) {
    const std::size_t mark = std::min(text.find('?'), text.size());
    path = text.substr(0, mark);
    query = text.substr(std::min(mark + 1, text.size()));
  }
  std::string_view operator[](std::string_view name) const {
    for (std::string_view rest = query; !rest.empty();) {
      const std::size_t end = std::min(rest.find('&'), rest.size());
      const std::string_view pair = rest.substr(0, end);
      if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=')
        return pair.substr(name.size() + 1);
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return {};
  }
  std::string_view path, query;
};

/// What all connections share.
struct Site {
  std::string page, word = random_word();
  std::array<std::string, 2> hosts;  // names of this machine with the port
  std::unique_ptr<DeskRoom> room;    // if the page may compute
};

Response response_to(unsigned version, http::status status, const char* type, std::string body) {
  Response out(status, version);
  out.set(http::field::content_type, type);
  out.set(http::field::cache_control, "no-store");
  out.set("X-Content-Type-Options", "nosniff");
  out.set("Referrer-Policy", "no-referrer");
  out.set("Cross-Origin-Resource-Policy", "same-origin");
  out.set("Content-Security-Policy", "frame-ancestors 'none'");
  out.body() = std::move(body);
  return out;
}

Response error_to(unsigned version, http::status status, const char* kind, std::string message) {
  return response_to(version, status, "application/json",
                     nlohmann::json{{"error", kind}, {"message", std::move(message)}}.dump());
}

/// Why a request is refused, or nothing.
std::string refusal(const Site& site, const http::request_header<>& head) {
  const auto is_here = [&](std::string_view host) {
    return host == site.hosts[0] || host == site.hosts[1];
  };
  if (!is_here(view_of(head[http::field::host]))) return "another host's name";
  const std::string_view origin = view_of(head[http::field::origin]);
  if (!origin.empty() && (!origin.starts_with("http://") || !is_here(origin.substr(7))))
    return "the page of another site";
  const Target target(view_of(head.target()));
  std::string_view given = view_of(head[http::field::authorization]);
  constexpr std::string_view scheme = "Bearer ";
  given = given.starts_with(scheme) ? given.substr(scheme.size()) : std::string_view();
  if (target.path == "/") given = target["token"];
  return same(given, site.word) ? "" : "the token is missing or wrong";
}

/// A browser's connection: one request after the other.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, Site& site) : stream_(std::move(socket)), site_(site) {}

  void read() {
    parser_.emplace();
    parser_->body_limit(site_.room ? largest_request : 0);
    stream_.expires_after(most_time);
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](beast::error_code error, std::size_t) {
                              if (!error) self->check();
                            });
  }

 private:
  /// Nothing is read of what is refused.
  void check() {
    const std::string why = refusal(site_, parser_->get());
    if (!why.empty()) {
      Response out = error_to(parser_->get().version(), http::status::forbidden, "Refused", why);
      out.keep_alive(false);
      return write(std::move(out));
    }
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](beast::error_code error, std::size_t) {
                       if (!error) return self->answer(self->parser_->release());
                       if (error != http::error::body_limit) return;
                       Response out = error_to(11, http::status::payload_too_large, "InputError",
                                               "the request is too large");
                       out.keep_alive(false);
                       self->write(std::move(out));
                     });
  }

  void answer(Request request) {
    const Target target(view_of(request.target()));
    const http::verb verb = request.method();
    const bool get = verb == http::verb::get, post = verb == http::verb::post;
    const auto done = [&](Response response) {
      response.keep_alive(request.keep_alive());
      write(std::move(response));
    };
    if (target.path == "/" && (get || verb == http::verb::head)) {
      Response out =
          response_to(request.version(), http::status::ok, "text/html; charset=utf-8", site_.page);
      out.content_length(site_.page.size());
      if (!get) out.body().clear();
      return done(std::move(out));
    }
    const std::string page(target["page"]);
    const std::string_view number = target["call"];
    std::uint64_t call = 0;
    const bool counted =
        std::from_chars(number.data(), number.data() + number.size(), call).ec == std::errc();
    const bool known = site_.room && ((target.path == "/call" && post && counted) ||
                                      (target.path == "/cancel" && post && counted) ||
                                      (target.path == "/progress" && get));
    if (!known)
      return done(error_to(request.version(), http::status::not_found, "InputError",
                           "there is nothing here"));
    if (target.path == "/progress")
      return done(response_to(request.version(), http::status::ok, "application/json",
                              site_.room->progress(page)));
    if (target.path == "/cancel") {
      site_.room->cancel(page, call);
      return done(response_to(request.version(), http::status::ok, "application/json", "{}"));
    }
    stream_.expires_never();
    const bool keep = request.keep_alive();
    const unsigned version = request.version();
    site_.room->answer(page, call, std::move(request.body()),
                       [self = shared_from_this(), keep, version](std::string body) {
                         asio::post(self->stream_.get_executor(),
                                    [self, keep, version, body = std::move(body)]() mutable {
                                      Response out =
                                          response_to(version, http::status::ok,
                                                      "application/octet-stream", std::move(body));
                                      out.keep_alive(keep);
                                      self->write(std::move(out));
                                    });
                       });
  }

  void write(Response response) {
    response_ = std::move(response);
    if (!response_.has_content_length()) response_.prepare_payload();
    stream_.expires_after(most_time);
    http::async_write(stream_, response_,
                      [self = shared_from_this()](beast::error_code error, std::size_t) {
                        if (error) return;
                        if (self->response_.keep_alive()) return self->read();
                        beast::error_code ignored;
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                      });
  }

  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  Response response_;
  Site& site_;
};

void accept(tcp::acceptor& acceptor, Site& site) {
  acceptor.async_accept([&](beast::error_code error, tcp::socket socket) {
    if (!error) std::make_shared<Connection>(std::move(socket), site)->read();
    if (error != asio::error::operation_aborted) accept(acceptor, site);
  });
}

}  // namespace

void serve_page(const std::string& page, const std::optional<desk::Given>& given, int threads,
                const Task& task) {
  asio::io_context io(1);
  std::optional<tcp::acceptor> acceptor;
  try {
    acceptor.emplace(io, tcp::endpoint(asio::ip::address_v4::loopback(), 0));
  } catch (const boost::system::system_error& e) {
    throw IoError(std::string("cannot open a port of 127.0.0.1: ") + e.what(), "system");
  }
  Site site;
  site.page = page;
  const std::string port = ":" + std::to_string(acceptor->local_endpoint().port());
  site.hosts = {"127.0.0.1" + port, "localhost" + port};
  if (given) site.room = std::make_unique<DeskRoom>(*given, threads);
  accept(*acceptor, site);
  std::cout << "http://" << site.hosts[0] << "/?token=" << site.word << "\n" << std::flush;
  while (true) {
    io.run_for(std::chrono::milliseconds(50));
    task.checkpoint();
  }
}

}  // namespace littoral::cli
