#include "core/io/net/http_server.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>
#include <thread>

#include "tests/core/io/message_of.h"
#include "tests/support/loopback.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

HttpAnswer Echo(const HttpRequest& request) {
  return {request.target == "/none" ? 404U : 200U,
          request.method + " " + request.target + " " + request.body};
}

/// Runs a Python program that knows `port`; what it prints.
std::string Python(const HttpServer& server, const std::string& program) {
  const std::string text =
      "import http.client, socket, threading; port = " + std::to_string(server.at().port) + "\n" +
      program;
  return RunCommand("python3 - <<'EOF'\n" + text + "\nEOF\ntrue").said;
}

// http.client is Python's own.
TEST(HttpServer, AnswersAClientThatKeepsItsConnection) {
  const HttpServer server(kAnyLoopbackPort, Echo);
  EXPECT_EQ(Python(server, R"(
client = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
for method, target, body in (("GET", "/a?b=c", None), ("POST", "/config", "{}"), ("GET", "/none", None)):
    client.request(method, target, body)
    answer = client.getresponse()
    print(answer.status, answer.getheader("Content-Type"), answer.read().decode()))"),
            "200 application/json GET /a?b=c \n"
            "200 application/json POST /config {}\n"
            "404 application/json GET /none \n");
}

TEST(HttpServer, ServesManyClientsAtOnceAndAfterEachOther) {
  const HttpServer server(kAnyLoopbackPort, Echo);
  EXPECT_EQ(Python(server, R"(
good = []
def ask(i):
    client = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    client.request("GET", f"/{i}")
    good.append(client.getresponse().read().decode() == f"GET /{i} ")
    client.close()
threads = [threading.Thread(target=ask, args=(i,)) for i in range(40)]
for thread in threads: thread.start()
for thread in threads: thread.join()
print(len(good), all(good)))"),
            "40 True\n");
}

// Requests that are no HTTP, too long, or never end, do not keep others from being served.
TEST(HttpServer, ClosesConnectionsThatAskTooMuch) {
  const HttpServer server(kAnyLoopbackPort, Echo);
  EXPECT_EQ(Python(server, R"(
def send(data):
    with socket.create_connection(("127.0.0.1", port), timeout=20) as sock:
        try:
            sock.sendall(data)
            return sock.recv(100)[:12]
        except OSError:
            return b""
print(send(b"hello\r\n\r\n"))
print(send(b"GET / HTTP/1.1\r\nX: " + b"x" * 100000 + b"\r\n\r\n"))
print(send(b"POST / HTTP/1.1\r\nContent-Length: 99999999\r\n\r\n"))
open_ones = [socket.create_connection(("127.0.0.1", port), timeout=20) for _ in range(8)]
print(send(b"GET /still HTTP/1.1\r\n\r\n")))"),
            "b''\nb''\nb''\nb'HTTP/1.1 200'\n");
}

// More than it holds: each further one closes the one that has waited for longest. Without that,
// nobody would be answered until they are given up, after kPatience_s.
TEST(HttpServer, AnswersBesideHundredsOfConnectionsThatAskNothing) {
  static_assert(HttpServer::kMaxConnections < 300 && HttpServer::kPatience_s > 8);
  const HttpServer server(kAnyLoopbackPort, Echo);
  EXPECT_EQ(Python(server, R"(
idle = [socket.create_connection(("127.0.0.1", port), timeout=8) for _ in range(300)]
for i in range(3):
    client = http.client.HTTPConnection("127.0.0.1", port, timeout=8)
    client.request("GET", f"/{i}")
    print(client.getresponse().read().decode())
print(idle[0].recv(1)))"),
            "GET /0 \nGET /1 \nGET /2 \nb''\n");
}

// The client is another process, so that the server's alone lacks descriptors.
TEST(HttpServer, WaitsIdlyWhileThereIsNoDescriptorLeft) {
  const HttpServer server(kAnyLoopbackPort, Echo);
  const std::string url = "http://127.0.0.1:" + std::to_string(server.at().port) + "/late";
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
  FILE* const client = ::popen(("python3 -c 'import urllib.request as web\n"
                                "print(web.urlopen(\"" +
                                url + "\", timeout=20).read().decode())' 2>&1")
                                   .c_str(),
                               "r");
  const int next = ::dup(STDIN_FILENO);
  ::close(next);
  const rlimit none_left{.rlim_cur = static_cast<rlim_t>(next), .rlim_max = limit.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none_left), 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(800));  // Python connects meanwhile.
  const std::clock_t before = std::clock();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const double busy_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
  std::array<char, 64> said{};
  EXPECT_NE(std::fgets(said.data(), said.size(), client), nullptr);
  ::pclose(client);
  EXPECT_STREQ(said.data(), "GET /late \n");
  // A server that tries without a pause is busy all the time.
  EXPECT_LT(busy_s, 0.15);
}

TEST(HttpServer, AnswersByIpv6) {
  const auto any = AnyIpv6LoopbackPort();
  if (!any) GTEST_SKIP() << "this machine has no IPv6 at ::1";
  const HttpServer server(*any, Echo);
  EXPECT_EQ(Python(server, R"(
client = http.client.HTTPConnection("::1", port, timeout=20)
client.request("GET", "/a")
print(client.getresponse().read().decode()))"),
            "GET /a \n");
  EXPECT_EQ(MessageOf([&] { const HttpServer other(server.at(), Echo); }),
            "[::1]:" + std::to_string(server.at().port) + ": Address already in use");
}

TEST(HttpServer, SaysThatAPortIsTaken) {
  const HttpServer server(kAnyLoopbackPort, Echo);
  EXPECT_EQ(MessageOf([&] { const HttpServer other(server.at(), Echo); }),
            EndpointText(server.at()) + ": Address already in use");
}

}  // namespace
}  // namespace railcast
