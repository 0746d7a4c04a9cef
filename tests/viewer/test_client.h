// A client of the viewer's server, and messages taken apart.
#pragma once

#include "viewer/server/server.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include <atomic>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace sprung::testing {

using Json = nlohmann::json;

inline constexpr const char* kToken = "secret";
inline constexpr const char* kPage = "<html><head></head><body></body></html>";

/// A server that serves in a thread of its own as long as it lives.
class ServingServer {
 public:
  explicit ServingServer(ViewSession& session, std::uint16_t port = 0)
      : server_({.port = port, .token = kToken, .page = kPage}, session),
        thread_([this] { server_.serve([this] { return stops_.load(); }); }) {}
  ~ServingServer() {
    stops_ = true;
    thread_.join();
  }

  [[nodiscard]] std::string port() const {
    const std::string address = server_.address();
    const std::size_t begin = address.rfind(':') + 1;
    return address.substr(begin, address.find('/', begin) - begin);
  }
  [[nodiscard]] std::string address() const { return server_.address(); }

 private:
  std::atomic<bool> stops_{false};
  ViewServer server_;
  std::thread thread_;
};

struct HttpAnswer {
  unsigned status = 0;
  std::string body;
};

inline HttpAnswer get(const std::string& port, const std::string& target, const std::string& host, const std::string& origin = "") {
  namespace http = boost::beast::http;
  boost::asio::io_context context;
  boost::beast::tcp_stream stream(context);
  stream.connect({boost::asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(std::stoi(port))});
  http::request<http::empty_body> request(http::verb::get, target, 11);
  request.set(http::field::host, host);
  if (!origin.empty()) request.set(http::field::origin, origin);
  http::write(stream, request);
  boost::beast::flat_buffer buffer;
  http::response<http::string_body> response;
  http::read(stream, buffer, response);
  return {response.result_int(), response.body()};
}

/// A message as it came.
struct Received {
  bool binary = false;
  std::vector<char> bytes;

  [[nodiscard]] Json json() const { return Json::parse(bytes.begin(), bytes.end()); }
  template <class Number>
  [[nodiscard]] Number at(std::size_t offset) const {
    Number number;
    if (offset + sizeof(Number) > bytes.size()) throw std::out_of_range("the message ends before byte " + std::to_string(offset));
    std::memcpy(&number, &bytes[offset], sizeof(Number));
    return number;
  }
  [[nodiscard]] std::uint32_t kind() const { return at<std::uint32_t>(0); }
  [[nodiscard]] std::uint32_t run() const { return at<std::uint32_t>(4); }
  [[nodiscard]] std::uint32_t generation() const { return at<std::uint32_t>(8); }
  [[nodiscard]] std::uint32_t frame() const { return at<std::uint32_t>(12); }
  [[nodiscard]] double time() const { return at<double>(16); }
  [[nodiscard]] std::uint32_t particles() const { return at<std::uint32_t>(24); }
  static constexpr std::size_t kHeader = 32 + 10 * sizeof(float);  // with the numbers of a frame
  [[nodiscard]] Vector3 position(std::size_t particle) const {
    const std::size_t begin = kHeader + 12 * particle;
    return {at<float>(begin), at<float>(begin + 4), at<float>(begin + 8)};
  }
  /// The bytes of all positions.
  [[nodiscard]] std::vector<char> positions() const {
    return {bytes.begin() + kHeader, bytes.begin() + kHeader + 12 * static_cast<std::ptrdiff_t>(particles())};
  }
};

/// A page: a WebSocket that waits for messages, at most ten seconds for each.
class TestPage {
 public:
  explicit TestPage(const std::string& port) : stream_(context_) {
    boost::beast::get_lowest_layer(stream_).connect(
        {boost::asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(std::stoi(port))});
    stream_.handshake("127.0.0.1:" + port, std::string("/live?token=") + kToken);
  }

  void send(const Json& message) {
    stream_.text(true);
    stream_.write(boost::asio::buffer(message.dump()));
  }

  void send_bytes(const std::string& bytes, bool as_text) {
    stream_.text(as_text);
    stream_.write(boost::asio::buffer(bytes));
  }

  Received receive() {
    bool done = false;
    boost::beast::error_code failure;
    boost::beast::flat_buffer buffer;
    boost::beast::get_lowest_layer(stream_).expires_after(std::chrono::seconds(10));
    stream_.async_read(buffer, [&](boost::beast::error_code error, std::size_t) {
      failure = error;
      done = true;
    });
    context_.restart();
    while (!done) context_.run_one();
    if (failure) throw std::runtime_error("no message came: " + failure.message());
    const std::string bytes = boost::beast::buffers_to_string(buffer.data());
    return {stream_.got_binary(), {bytes.begin(), bytes.end()}};
  }

  /// The next text of a type; other messages are dropped.
  Json text(const std::string& type) {
    while (true) {
      const Received message = receive();
      if (!message.binary && message.json().at("type") == type) return message.json();
    }
  }

  /// The next binary message; texts are dropped.
  Received binary() {
    while (true) {
      Received message = receive();
      if (message.binary) return message;
    }
  }

  /// The next frame for which `wanted` is true; other messages are dropped.
  template <class Wanted>
  Received frame(Wanted wanted) {
    while (true) {
      Received message = receive();
      if (message.binary && message.kind() == 2 && wanted(message)) return message;
    }
  }
  Received frame() {
    return frame([](const Received&) { return true; });
  }

 private:
  boost::asio::io_context context_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
};

}  // namespace sprung::testing
