// Which requests the viewer's server answers.
#include "viewer/server/request_check.h"

#include <gtest/gtest.h>

#include <set>

namespace sprung {
namespace {

constexpr const char* kToken = "secret";

RequestTarget check(std::string_view target, std::string_view host = "127.0.0.1:8000", std::string_view origin = "",
                    std::string_view method = "GET") {
  return check_request({.method = method, .target = target, .host = host, .origin = origin}, kToken);
}

TEST(RequestCheck, GivesThePageAndTheSocketToWhoeverKnowsTheToken) {
  EXPECT_EQ(check("/?token=secret"), RequestTarget::page);
  EXPECT_EQ(check("/live?token=secret"), RequestTarget::socket);
  EXPECT_EQ(check("/?a=b&token=secret"), RequestTarget::page);
  EXPECT_EQ(check("/?token=secret", "localhost:9000", "http://localhost:9000"), RequestTarget::page);
  EXPECT_EQ(check("/live?token=secret", "127.0.0.1:8000", "http://127.0.0.1:8000"), RequestTarget::socket);
}

TEST(RequestCheck, RefusesRequestsWithoutTheToken) {
  for (const char* target : {"/", "/?", "/?token", "/?token=", "/?token=secre", "/?token=secrets", "/?token=Secret",
                             "/?tokens=secret", "/?x=token=secret", "/live", "token=secret", "", "/?token=wrong&token=secret"}) {
    EXPECT_EQ(check(target), RequestTarget::refused) << target;
  }
}

TEST(RequestCheck, RefusesOtherPaths) {
  for (const char* path : {"/index.html", "/../etc/passwd", "//", "/live/", "/%2e%2e/", "*", "http://127.0.0.1/", "/favicon.ico"}) {
    EXPECT_EQ(check(std::string(path) + "?token=secret"), RequestTarget::refused) << path;
  }
}

TEST(RequestCheck, RefusesForeignHosts) {
  for (const char* host : {"", "evil.example", "evil.example:8000", "127.0.0.1.evil.example", "localhost.evil.example",
                           "127.0.0.1:", "127.0.0.1:80x", "127.0.0.1@evil.example", "[::1]:8000", "0.0.0.0:8000"}) {
    EXPECT_EQ(check("/?token=secret", host), RequestTarget::refused) << host;
  }
}

TEST(RequestCheck, RefusesForeignOrigins) {
  for (const char* origin : {"null", "http://evil.example", "https://127.0.0.1:8000", "http://127.0.0.1:8001", "http://127.0.0.1",
                             "http://localhost:8000", "127.0.0.1:8000", "file://"}) {
    EXPECT_EQ(check("/live?token=secret", "127.0.0.1:8000", origin), RequestTarget::refused) << origin;
  }
}

TEST(RequestCheck, RefusesOtherMethods) {
  for (const char* method : {"POST", "HEAD", "PUT", "OPTIONS", "CONNECT", "get"}) {
    EXPECT_EQ(check("/?token=secret", "127.0.0.1:8000", "", method), RequestTarget::refused) << method;
  }
}

TEST(RequestCheck, TokensDiffer) {
  std::set<std::string> tokens;
  for (int k = 0; k < 100; ++k) {
    const std::string token = random_token();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << token;
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 100u);
}

}  // namespace
}  // namespace sprung
