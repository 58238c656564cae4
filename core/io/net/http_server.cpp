#include "core/io/net/http_server.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <cstdint>
#include <list>
#include <optional>
#include <thread>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;
using Tcp = asio::ip::tcp;

constexpr std::chrono::milliseconds kPauseAfterError{100};

class HttpConnection;
/// The one that has waited for longest is first.
using OpenConnections = std::list<HttpConnection*>;

/// One connection; lives as long as something is awaited on it.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  /// @param open Holds the connection until it is closed.
  HttpConnection(Tcp::socket socket, const HttpServer::Answer& answer, OpenConnections& open)
      : stream_(std::move(socket)), answer_(answer), open_(open) {}
  ~HttpConnection() { open_.remove(this); }
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  void Close() {
    open_.remove(this);
    stream_.close();
  }

  void Read() {
    BeginWaiting();
    parser_.emplace();
    parser_->header_limit(HttpServer::kMaxHeaderBytes);
    parser_->body_limit(HttpServer::kMaxBodyBytes);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](const error_code& error, std::size_t) {
                       if (!error) self->Write();
                     });
  }

 private:
  void BeginWaiting() {
    open_.remove(this);
    open_.push_back(this);
    stream_.expires_after(std::chrono::seconds(HttpServer::kPatience_s));
  }

  void Write() {
    const http::request<http::string_body>& request = parser_->get();
    HttpAnswer answer = answer_({.method = std::string(request.method_string()),
                                 .target = std::string(request.target()),
                                 .body = request.body()});
    response_ = {static_cast<http::status>(answer.status), request.version()};
    response_.set(http::field::content_type, answer.content_type);
    response_.keep_alive(request.keep_alive());
    response_.body() = std::move(answer.body);
    response_.prepare_payload();
    if (request.method() == http::verb::head) response_.body().clear();
    BeginWaiting();
    http::async_write(
        stream_, response_, [self = shared_from_this()](const error_code& error, std::size_t) {
          if (error) return;
          if (self->response_.keep_alive()) return self->Read();
          error_code ignored;
          static_cast<void>(self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored));
        });
  }

  beast::tcp_stream stream_;
  const HttpServer::Answer& answer_;
  OpenConnections& open_;
  beast::flat_buffer buffer_{HttpServer::kMaxHeaderBytes + HttpServer::kMaxBodyBytes};
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::string_body> response_;
};

Tcp::endpoint TcpEndpointOf(const Endpoint& at) {
  if (at.address.is_ipv4()) return {asio::ip::address_v4(at.address.ipv4()), at.port};
  return {asio::ip::address_v6(at.address.bytes, at.address.interface), at.port};
}

}  // namespace

struct HttpServer::Parts {
  Answer answer;
  Endpoint at;
  // Used by the server's thread, and by connections that end when the context does.
  OpenConnections open;
  asio::io_context context{1};
  Tcp::acceptor acceptor{context};
  asio::steady_timer pause{context};
  std::thread thread;

  void Accept() {
    acceptor.async_accept([this](const error_code& error, Tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) return AcceptLater();
      if (open.size() >= kMaxConnections) open.front()->Close();
      std::make_shared<HttpConnection>(std::move(socket), answer, open)->Read();
      Accept();
    });
  }
  /// Where the process has no descriptor left, the connection still waits: another try at once
  /// would fail, too, and keep a core busy.
  void AcceptLater() {
    pause.expires_after(kPauseAfterError);
    pause.async_wait([this](const error_code& error) {
      if (!error) Accept();
    });
  }
};

HttpServer::HttpServer(const Endpoint& at, Answer answer) : parts_(std::make_unique<Parts>()) {
  parts_->answer = std::move(answer);
  try {
    const Tcp::endpoint endpoint = TcpEndpointOf(at);
    parts_->acceptor.open(endpoint.protocol());
    // Beside 0.0.0.0, [::] is for IPv6 alone.
    if (!at.address.is_ipv4()) parts_->acceptor.set_option(asio::ip::v6_only(true));
    parts_->acceptor.set_option(Tcp::acceptor::reuse_address(true));
    parts_->acceptor.bind(endpoint);
    parts_->acceptor.listen();
  } catch (const boost::system::system_error& error) {
    throw InputError(EndpointText(at) + ": " + error.code().message());
  }
  parts_->at = {at.address, parts_->acceptor.local_endpoint().port()};
  parts_->Accept();
  parts_->thread = std::thread([parts = parts_.get()] { parts->context.run(); });
}

HttpServer::~HttpServer() {
  parts_->context.stop();
  parts_->thread.join();
}

const Endpoint& HttpServer::at() const {
  return parts_->at;
}

}  // namespace railcast
