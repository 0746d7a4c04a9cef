#include "viewer/server/server.h"

#include "base/error.h"
#include "viewer/protocol/text_messages.h"
#include "viewer/server/board.h"
#include "viewer/server/request_check.h"

#include <boost/asio/dispatch.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace sprung {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

constexpr std::chrono::seconds kRequestTime{10};
constexpr std::chrono::seconds kAnswerTime{60};  // the page through a slow tunnel
constexpr std::chrono::milliseconds kAcceptPause{100};
constexpr std::chrono::milliseconds kStopCheck{50};
constexpr std::size_t kMaxRequest = 64 * 1024;  // [bytes]
constexpr std::size_t kMaxMessage = 64 * 1024;  // [bytes]
// A page that lets so many answers wait does not read any more.
constexpr std::size_t kMaxWaiting = 1000;
constexpr std::size_t kMaxWaitingBytes = 256 * 1024 * 1024;

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

/// One WebSocket. Lives as long as operations on it do.
class Page : public std::enable_shared_from_this<Page> {
 public:
  struct Calls {
    std::function<std::optional<Outgoing>(Reader&)> next;  ///< the next message for the page, if there is one
    std::function<void(ClientId, std::string)> receive;
    std::function<void(ClientId)> leave;
  };

  Page(tcp::socket socket, ClientId id, Calls calls) : stream_(std::move(socket)), id_(id), calls_(std::move(calls)) {}

  template <class Opened>
  void accept(const Request& request, Opened opened) {
    stream_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    stream_.read_message_max(kMaxMessage);
    stream_.async_accept(request, [self = shared_from_this(), opened = std::move(opened)](beast::error_code error) {
      if (error) return;
      self->open_ = true;
      opened();
      self->send_next();
      self->read();
    });
  }

  void push(Outgoing message) {
    std::size_t bytes = 0;
    for (const Outgoing& waiting : reader_.waiting) bytes += waiting.bytes->size();
    if (reader_.waiting.size() >= kMaxWaiting || bytes >= kMaxWaitingBytes) return close();
    reader_.waiting.push_back(std::move(message));
    send_next();
  }

  /// Sends what is new to this page, one message at a time.
  void send_next() {
    if (!open_ || writing_) return;
    auto next = calls_.next(reader_);
    if (!next) return;
    writing_ = true;
    stream_.binary(next->binary);
    const auto buffer = asio::buffer(*next->bytes);
    stream_.async_write(buffer, [self = shared_from_this(), kept = next->bytes](beast::error_code error, std::size_t) {
      self->writing_ = false;
      if (error) return self->end();
      self->send_next();
    });
  }

  void close() {
    if (!open_) return;
    beast::error_code ignored;
    beast::get_lowest_layer(stream_).socket().close(ignored);
    end();
  }

 private:
  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (error) return self->end();
      if (self->stream_.got_binary()) return self->close();
      self->calls_.receive(self->id_, beast::buffers_to_string(self->buffer_.data()));
      self->buffer_.consume(self->buffer_.size());
      self->read();
    });
  }

  void end() {
    if (!open_) return;
    open_ = false;
    calls_.leave(id_);
  }

  websocket::stream<beast::tcp_stream> stream_;
  ClientId id_;
  Calls calls_;
  Reader reader_;
  beast::flat_buffer buffer_;
  bool open_ = false;
  bool writing_ = false;
};

/// A connection until it has made its one request.
struct Visitor {
  explicit Visitor(tcp::socket socket) : stream(std::move(socket)) {}

  beast::tcp_stream stream;
  beast::flat_buffer buffer;
  http::request_parser<http::string_body> parser;
  Response response;
};

tcp::acceptor listen(asio::io_context& context, std::uint16_t port) try {
  tcp::acceptor acceptor(context);
  const tcp::endpoint endpoint(asio::ip::address_v4::loopback(), port);
  acceptor.open(endpoint.protocol());
  acceptor.set_option(asio::socket_base::reuse_address(true));
  acceptor.bind(endpoint);
  acceptor.listen();
  return acceptor;
} catch (const boost::system::system_error& error) {
  throw InputError({"", "--port", std::to_string(port), "cannot be listened on: " + error.code().message(),
                    "give another port, or leave --port out to take a free one"});
}

}  // namespace

struct ViewServer::Implementation final : Publisher {
  Implementation(ServerSettings chosen, ViewSession& shown)
      : settings(std::move(chosen)), session(shown), acceptor(listen(context, settings.port)), board(session.hello()) {}

  // The session calls these from its thread.
  void show_scene(std::uint32_t run, std::string scene, SharedBytes topology) override {
    show([&] { board.show_scene(run, scene, std::move(topology)); });
  }
  void show_frame(std::uint32_t run, SharedBytes frame) override {
    show([&] { board.show_frame(run, std::move(frame)); });
  }
  void show_divergence(std::uint32_t run, std::string text) override {
    show([&] { board.show_divergence(run, text); });
  }
  void remove_run(std::uint32_t run, std::string text) override {
    show([&] { board.remove_run(run, text); });
  }
  void show_state(std::string text) override {
    show([&] { board.show_state(text); });
  }
  void show_failure(std::string text) override {
    show([&] { board.show_failure(text); });
  }
  void tell_all(std::string text) override {
    asio::post(context, [this, bytes = Board::text(text)] { for_all([&](Page& page) { page.push({bytes, false}); }); });
  }
  void tell(ClientId client, std::string text) override { push(client, {Board::text(text), false}); }
  void send(ClientId client, SharedBytes frame) override { push(client, {std::move(frame), true}); }

  /// Changes the board, and wakes the server unless it is about to look at the board anyway.
  template <class Show>
  void show(const Show& change) {
    {
      const std::lock_guard lock(board_mutex);
      change();
    }
    if (woken.exchange(true)) return;
    asio::post(context, [this] {
      woken = false;
      for_all([](Page& page) { page.send_next(); });
    });
  }

  [[nodiscard]] std::optional<Outgoing> next(Reader& reader) {
    const std::lock_guard lock(board_mutex);
    return board.next(reader);
  }

  void push(ClientId client, Outgoing message) {
    asio::post(context, [this, client, message = std::move(message)] {
      const auto found = pages.find(client);
      if (found != pages.end()) std::shared_ptr<Page>(found->second)->push(message);
    });
  }

  /// A page may leave while it is called.
  template <class Call>
  void for_all(Call call) {
    const auto all = pages;
    for (const auto& [id, page] : all) call(*page);
  }

  void accept() {
    acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) return accept_later();
      receive(std::make_shared<Visitor>(std::move(socket)));
      accept();
    });
  }

  /// A system that is out of sockets fails at once, again and again.
  void accept_later() {
    accept_timer.expires_after(kAcceptPause);
    accept_timer.async_wait([this](beast::error_code error) {
      if (!error) accept();
    });
  }

  void receive(const std::shared_ptr<Visitor>& visitor) {
    visitor->parser.body_limit(kMaxRequest);
    visitor->stream.expires_after(kRequestTime);
    http::async_read(visitor->stream, visitor->buffer, visitor->parser, [this, visitor](beast::error_code error, std::size_t) {
      if (!error) answer(visitor);
    });
  }

  void answer(const std::shared_ptr<Visitor>& visitor) {
    const Request& request = visitor->parser.get();
    const RequestTarget target = check_request({.method = view_of(request.method_string()),
                                                .target = view_of(request.target()),
                                                .host = view_of(request[http::field::host]),
                                                .origin = view_of(request[http::field::origin])},
                                               settings.token);
    if (target == RequestTarget::socket && websocket::is_upgrade(request)) return open_page(*visitor, request);
    Response& response = visitor->response;
    response.version(request.version());
    response.keep_alive(false);
    response.set(http::field::cache_control, "no-store");
    if (target == RequestTarget::page) {
      response.result(http::status::ok);
      response.set(http::field::content_type, "text/html; charset=utf-8");
      response.body() = settings.page;
    } else {
      response.result(http::status::forbidden);
      response.set(http::field::content_type, "text/plain; charset=utf-8");
      response.body() = "403: use the address that sprung view printed, with its token.\n";
    }
    response.prepare_payload();
    visitor->stream.expires_after(kAnswerTime);
    http::async_write(visitor->stream, response, [visitor](beast::error_code, std::size_t) {
      beast::error_code ignored;
      visitor->stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  void open_page(Visitor& visitor, const Request& request) {
    visitor.stream.expires_never();
    const ClientId id = ++last_id;
    const Page::Calls calls{.next = [this](Reader& reader) { return next(reader); },
                            .receive = [this](ClientId client, std::string text) { session.handle(client, std::move(text)); },
                            .leave =
                                [this](ClientId client) {
                                  pages.erase(client);
                                  session.leave(client);
                                  session.set_watchers(static_cast<int>(pages.size()));
                                }};
    const auto page = std::make_shared<Page>(visitor.stream.release_socket(), id, calls);
    page->accept(request, [this, id, page] {
      pages[id] = page;
      session.set_watchers(static_cast<int>(pages.size()));
    });
  }

  void watch_for_stop(const std::function<bool()>& stops) {
    timer.expires_after(kStopCheck);
    timer.async_wait([this, &stops](beast::error_code error) {
      if (error) return;
      if (stops()) return context.stop();
      watch_for_stop(stops);
    });
  }

  ServerSettings settings;
  ViewSession& session;
  asio::io_context context{1};
  tcp::acceptor acceptor;
  asio::steady_timer timer{context};
  asio::steady_timer accept_timer{context};
  std::mutex board_mutex;
  Board board;
  std::atomic<bool> woken{false};  ///< whether the server is about to look at the board
  std::map<ClientId, std::shared_ptr<Page>> pages;
  ClientId last_id = 0;
};

ViewServer::ViewServer(ServerSettings settings, ViewSession& session)
    : implementation_(std::make_unique<Implementation>(std::move(settings), session)) {}
ViewServer::~ViewServer() = default;

std::string ViewServer::address() const {
  return "http://127.0.0.1:" + std::to_string(implementation_->acceptor.local_endpoint().port()) +
         "/?token=" + implementation_->settings.token;
}

void ViewServer::serve(const std::function<bool()>& stops) {
  // The session must not publish to a server that is gone, whichever way this ends.
  struct Stop {
    ViewSession& session;
    ~Stop() { session.stop(); }
  } const stop{implementation_->session};
  implementation_->session.start(*implementation_);
  implementation_->accept();
  implementation_->watch_for_stop(stops);
  implementation_->context.run();
}

}  // namespace sprung
