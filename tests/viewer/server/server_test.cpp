// Laws of the server, whatever it shows.
#include "viewer/server/server.h"
#include "viewer/test_client.h"

#include <gtest/gtest.h>

#include <memory>
#include <mutex>

namespace sprung {
namespace {

using testing::ServingServer;
using testing::TestPage;

/// Publishes frames from a thread of its own as fast as it can, and notes what the server tells it.
class BusySession final : public ViewSession {
 public:
  ~BusySession() override { stop(); }

  [[nodiscard]] std::string hello() const override { return R"({"type": "hello"})"; }
  void start(Publisher& publisher) override {
    publisher.show_scene(0, R"({"type": "scene"})", std::make_shared<const Bytes>(32, std::uint8_t{1}));
    thread_ = std::thread([this, &publisher] {
      while (!ends_) publisher.show_frame(0, std::make_shared<const Bytes>(200'000, std::uint8_t{2}));
    });
  }
  void stop() override {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
  }
  void handle(ClientId /*client*/, std::string text) override {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(text));
  }
  void set_watchers(int count) override { watchers_ = count; }
  void leave(ClientId /*client*/) override { ++left_; }

  [[nodiscard]] bool is_stopped() const { return ends_ && !thread_.joinable(); }
  [[nodiscard]] int watchers() const { return watchers_; }
  [[nodiscard]] int left() const { return left_; }
  [[nodiscard]] std::vector<std::string> messages() {
    const std::lock_guard lock(mutex_);
    return messages_;
  }

 private:
  std::atomic<bool> ends_{false};
  std::atomic<int> watchers_{0};
  std::atomic<int> left_{0};
  std::mutex mutex_;
  std::vector<std::string> messages_;
  std::thread thread_;
};

/// Waits for ten seconds at most.
template <class Condition>
bool becomes(Condition condition) {
  for (int k = 0; k < 1000 && !condition(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

TEST(Server, EndsItsSessionBeforeItEnds) {
  BusySession session;
  {
    ServingServer server(session);
    TestPage page(server.port());
    page.binary();
  }
  EXPECT_TRUE(session.is_stopped());
}

// It would hold gigabytes if each frame waited for it.
TEST(Server, APageThatDoesNotReadMissesFramesAndStaysConnected) {
  BusySession session;
  ServingServer server(session);
  TestPage slow(server.port());
  TestPage quick(server.port());
  for (int k = 0; k < 200; ++k) quick.binary();
  EXPECT_EQ(slow.receive().json()["type"], "hello");
  for (int k = 0; k < 10; ++k) slow.binary();
  EXPECT_EQ(session.watchers(), 2);
}

TEST(Server, TheSessionIsToldWhichPagesComeAndGo) {
  BusySession session;
  ServingServer server(session);
  {
    TestPage first(server.port());
    TestPage second(server.port());
    first.binary();
    second.binary();
    EXPECT_EQ(session.watchers(), 2);
  }
  EXPECT_TRUE(becomes([&] { return session.watchers() == 0; }));
  EXPECT_EQ(session.left(), 2);
}

TEST(Server, APageThatBreaksTheProtocolIsClosedAndOthersStay) {
  BusySession session;
  ServingServer server(session);
  TestPage good(server.port());
  good.binary();
  const std::vector<std::pair<std::string, bool>> hostile{
      {"\xff\xfe", true}, {R"({"do": "play"})", false}, {std::string(70'000, 'x'), true}, {std::string(70'000, '\0'), false}};
  for (const auto& [bytes, as_text] : hostile) {
    TestPage page(server.port());
    page.binary();
    page.send_bytes(bytes, as_text);
    EXPECT_THROW(while (true) page.receive(), std::runtime_error);
  }
  EXPECT_TRUE(becomes([&] { return session.watchers() == 1; }));
  good.send({{"do", "play"}});
  EXPECT_TRUE(becomes([&] { return session.messages() == std::vector<std::string>{R"({"do":"play"})"}; }));
}

// Bytes that are no HTTP request, and requests that never end.
TEST(Server, AConnectionThatMakesNoRequestHurtsNobody) {
  BusySession session;
  ServingServer server(session);
  boost::asio::io_context context;
  std::vector<boost::asio::ip::tcp::socket> sockets;
  for (const std::string bytes :
       {"", "\x16\x03\x01", "GET / HTTP/1.1\r\nHost: ", "POST / HTTP/1.1\r\nContent-Length: 9999999\r\n\r\nx"}) {
    sockets.emplace_back(context);
    sockets.back().connect({boost::asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(std::stoi(server.port()))});
    boost::asio::write(sockets.back(), boost::asio::buffer(bytes));
  }
  sockets.front().close();
  EXPECT_EQ(testing::get(server.port(), "/?token=secret", "localhost").body, testing::kPage);
}

}  // namespace
}  // namespace sprung
