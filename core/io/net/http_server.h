#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "railcast/io/endpoint.h"

namespace railcast {

struct HttpRequest {
  std::string method;  ///< "GET", "POST", ...
  std::string target;  ///< Path and query, as they were sent.
  std::string body;
};

struct HttpAnswer {
  unsigned status = 200;
  std::string body;
  std::string content_type = "application/json";
};

/// Answers HTTP requests on a thread of its own, while the object lives.
///
/// It has at most kMaxConnections at once: for one more, the one that has neither asked nor read
/// for longest is closed, so that nobody is kept from asking. A connection that does neither for
/// kPatience_s is closed, and so is one whose request is larger than the limits.
class HttpServer {
 public:
  static constexpr std::size_t kMaxConnections = 256;
  static constexpr std::size_t kMaxHeaderBytes = 8192;
  static constexpr std::size_t kMaxBodyBytes = 65'536;
  static constexpr int kPatience_s = 10;

  using Answer = std::function<HttpAnswer(const HttpRequest&)>;

  /// @param at Port 0 takes a free one.
  /// @param answer Called from the server's thread, one request after the other.
  /// @throws InputError if the port is taken or not allowed.
  HttpServer(const Endpoint& at, Answer answer);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  [[nodiscard]] const Endpoint& at() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace railcast
