#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <set>
#include <sstream>
#include <thread>

#include "server/http/routes.h"
#include "server/http/secrets.h"
#include "tests/http/running_server.h"

namespace penumbra::server::http {
namespace {

using AccessToTheServer = RunningServer;

/// A route's path with something in its places.
std::string example(std::string path) {
  for (auto open = path.find('{'); open != std::string::npos; open = path.find('{'))
    path.replace(open, path.find('}') - open + 1, "thesis-2007");
  return path;
}

httplib::Result call(httplib::Client& client, const std::string& method, const std::string& path,
                     const httplib::Headers& headers) {
  if (method == "GET") return client.Get(path, headers);
  if (method == "DELETE") return client.Delete(path, headers);
  if (method == "PUT") return client.Put(path, headers, "{}", "application/json");
  return client.Post(path, headers, "{}", "application/json");
}

TEST_F(AccessToTheServer, ToResearchersCallsNeedsTheToken) {
  for (const auto& route : routes()) {
    if (route.access != Access::researcher) continue;
    EXPECT_EQ(error_of(call(*client, route.method, example(route.path), {}), 401), "unauthorized")
        << route.method << " " << route.path;
  }
}

TEST_F(AccessToTheServer, IsGivenByTheToken) {
  body_of(researcher->Get("/api/v1/studies"), 200, "StudyList");
}

TEST_F(AccessToTheServer, IsGivenByTheSessionThatTheTokenOpens) {
  const auto opened = client->Get("/lab?token=" + server->token());
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->status, 303);
  EXPECT_EQ(opened->get_header_value("Location"), "/lab");
  const auto cookie = opened->get_header_value("Set-Cookie");
  EXPECT_NE(cookie.find("HttpOnly"), std::string::npos);
  EXPECT_NE(cookie.find("SameSite=Strict"), std::string::npos);
  EXPECT_EQ(cookie.find(server->token()), std::string::npos);
  const auto pair = cookie.substr(0, cookie.find(';'));
  body_of(client->Get("/api/v1/studies", {{"Cookie", "other=1; " + pair}}), 200, "StudyList");
  EXPECT_EQ(error_of(client->Get("/api/v1/studies", {{"Cookie", pair + "0"}}), 401),
            "unauthorized");
  EXPECT_EQ(error_of(client->Get("/lab?token=wrong"), 401), "unauthorized");
  EXPECT_EQ(error_of(client->Get("/lab"), 401), "unauthorized");
}

TEST_F(AccessToTheServer, IsRefusedToOtherSites) {
  const std::string own = "http://127.0.0.1:" + std::to_string(server->port());
  const auto publish = [&](const httplib::Headers& headers) {
    return call(*researcher, "POST", "/api/v1/studies/unknown/publish", headers);
  };
  EXPECT_EQ(error_of(publish({{"Origin", "https://evil.example"}}), 403), "forbidden");
  EXPECT_EQ(error_of(publish({{"Origin", "null"}}), 403), "forbidden");
  EXPECT_EQ(error_of(publish({{"Origin", own + ".evil.example"}}), 403), "forbidden");
  EXPECT_EQ(error_of(publish({{"Sec-Fetch-Site", "cross-site"}}), 403), "forbidden");
  EXPECT_EQ(error_of(publish({{"Origin", own}}), 404), "not_found");
  EXPECT_EQ(error_of(publish({}), 404), "not_found");
}

TEST_F(AccessToTheServer, IsNotGuessed) {
  std::set<int> states;
  for (int i = 0; i < 60; ++i)
    states.insert(client->Get("/api/v1/studies", {{"Authorization", "Bearer guess"}})->status);
  EXPECT_EQ(states, (std::set<int>{401, 429}));
  // The right guess among them would tell itself; it too has to wait until there is one left.
  EXPECT_EQ(error_of(researcher->Get("/api/v1/studies"), 429), "too_many");
  EXPECT_EQ(client->Get("/api/v1/participants/guess")->status, 429);
  EXPECT_EQ(error_of(client->Get("/lab?token=" + server->token()), 429), "too_many");
  std::this_thread::sleep_for(std::chrono::milliseconds(2100));
  body_of(researcher->Get("/api/v1/studies"), 200, "StudyList");
}

TEST_F(AccessToTheServer, PreviewsAreNoPlaceToGuessAt) {
  ASSERT_EQ(publish("thesis-2007"), "open");
  std::set<int> states;
  for (int i = 0; i < 60; ++i)
    states.insert(client
                      ->Post("/api/v1/studies/thesis-2007/participants",
                             {{"Authorization", "Bearer guess"}}, R"({"preview":true})",
                             "application/json")
                      ->status);
  EXPECT_EQ(states, (std::set<int>{401, 429}));
}

TEST_F(AccessToTheServer, DraftsAreNotFound) {
  const auto unknown = client->Get("/s/unknown");
  const auto draft = client->Get("/s/thesis-2007");
  EXPECT_EQ(error_of(draft, 404), "not_found");
  EXPECT_EQ(draft->body, unknown->body);
  ASSERT_EQ(publish("thesis-2007"), "open");
  EXPECT_EQ(client->Get("/s/thesis-2007")->status, 200);
}

/// What participants need, after the contract; all else is the researcher's.
const std::set<std::string> participants_calls{
    "GET /s/{study}",
    "GET /s/{study}/welcome",
    "GET /assets/{folder}/{file}",
    "POST /api/v1/studies/{id}/participants",
    "GET /api/v1/participants/{token}",
    "PUT /api/v1/participants/{token}/screen",
    "PUT /api/v1/participants/{token}/pages/{page}",
    "GET /api/v1/participants/{token}/pages/{page}/pictures/{slot}",
    "GET /api/v1/participants/{token}/pages/{page}/pictures/{slot}/{frame}",
    "POST /api/v1/participants/{token}/complete",
    "DELETE /api/v1/withdrawals/{code}",
    "GET /lab",  // asks for the token itself
};

class AccessFromOutside : public RunningServer {
 protected:
  void expect_the_researcher_alone() {
    for (const auto& route : routes()) {
      const bool open = participants_calls.contains(route.method + " " + route.path);
      const auto result = call(*client, route.method, example(route.path), {});
      if (open)
        EXPECT_TRUE(result->status != 401 || route.path == "/lab") << route.method << route.path;
      else
        EXPECT_EQ(error_of(result, 401), "unauthorized") << route.method << " " << route.path;
    }
    EXPECT_EQ(error_of(client->Get("/api/v1/image?scene=boxes&technique=none"), 401),
              "unauthorized");
    EXPECT_EQ(renders->submitted, 0);
    const auto image = researcher->Get("/api/v1/image?scene=boxes&technique=none");
    EXPECT_EQ(image->status, 200);
    EXPECT_TRUE(image->get_header_value("Cache-Control").starts_with("private"));
    EXPECT_EQ(client->Get("/lab?token=" + server->token())->status, 303);
  }
};

TEST_F(AccessFromOutside, NeedsTheTokenWhereThereIsAPublicAddress) {
  stop();
  options.public_url = "https://study.example.org";
  start();
  expect_the_researcher_alone();
}

TEST_F(AccessFromOutside, NeedsTheTokenWhereOtherMachinesReachTheServer) {
  stop();
  options.host = "0.0.0.0";
  start();
  expect_the_researcher_alone();
}

TEST_F(AccessFromOutside, IsOpenToProgramsOfThisMachineAlone) {
  body_of(client->Get("/api/v1/scenes"), 200, "SceneList");
  EXPECT_EQ(client->Get("/api/v1/image?scene=boxes&technique=none")->status, 200);
  // A page of another site whose name was pointed at this machine.
  EXPECT_EQ(error_of(client->Post("/api/v1/renders",
                                  {{"Host", "evil.example"}, {"Origin", "http://evil.example"}},
                                  R"({"scene":"boxes","technique":"none"})", "application/json"),
                     403),
            "forbidden");
}

TEST_F(AccessFromOutside, TrustsNoHostWhereThePublicAddressIsKnown) {
  stop();
  options.public_url = "https://study.example.org";
  start();
  const auto from = [&](const std::string& host, const std::string& origin) {
    return researcher->Post("/api/v1/studies/unknown/publish", {{"Host", host}, {"Origin", origin}},
                            "", "application/json");
  };
  EXPECT_EQ(from("evil.example", "https://evil.example")->status, 403);
  EXPECT_EQ(from("study.example.org", "http://study.example.org")->status, 403);
  EXPECT_EQ(from("anything", "https://study.example.org")->status, 404);
}

TEST_F(AccessFromOutside, PublicAddressesThatAreNoneAreNamed) {
  for (const std::string address : {"study.example.org", "ftp://x", "https://", "http:///x"}) {
    ServeOptions wrong;
    wrong.port = wrong.ops_port = 0;
    wrong.data = folder.path / "other";
    wrong.public_url = address;
    try {
      Server second(wrong, [] { return std::make_unique<FakeRenders>(); });
      ADD_FAILURE() << address;
    } catch (const Error& error) {
      EXPECT_EQ(error.field, "public_url");
    }
  }
}

TEST_F(AccessToTheServer, TokensNeverReachTheLog) {
  std::ostringstream text;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text)));
  client->Get("/lab?token=" + server->token());
  researcher->Get("/api/v1/studies");
  client->Get("/api/v1/participants/a-persons-token");
  client->Delete("/api/v1/withdrawals/a-persons-code");
  spdlog::set_default_logger(before);
  EXPECT_NE(text.str().find("/api/v1/participants/{token}"), std::string::npos) << text.str();
  EXPECT_EQ(text.str().find(server->token()), std::string::npos);
  EXPECT_EQ(text.str().find("a-persons"), std::string::npos);
}

TEST_F(AccessToTheServer, EveryAnswerCarriesTheHeadersThatPagesNeed) {
  for (const std::string path : {"/api/v1/scenes", "/nothing", "/s/thesis-2007/welcome", "/lab"}) {
    const auto result = client->Get(path);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->get_header_value("X-Content-Type-Options"), "nosniff") << path;
    EXPECT_EQ(result->get_header_value("Referrer-Policy"), "no-referrer") << path;
    const auto policy = result->get_header_value("Content-Security-Policy");
    EXPECT_NE(policy.find("default-src 'none'"), std::string::npos) << path;
    EXPECT_EQ(policy.find("unsafe"), std::string::npos) << path;
  }
}

TEST_F(AccessToTheServer, TheTokenFileIsItsOwnersAlone) {
  struct stat state {};
  ASSERT_EQ(::stat((folder.path / "data" / "researcher.token").c_str(), &state), 0);
  EXPECT_EQ(state.st_mode & 0777, 0600u);
  const auto token = server->token();
  restart();
  EXPECT_EQ(server->token(), token);
}

std::string complaint_about(const std::filesystem::path& file) {
  try {
    researcher_token(file);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.field, "token_file");
    return error.what();
  }
}

TEST(Secrets, TokensThatOthersMayHaveChosenOrGuessAreRefused) {
  using std::filesystem::perms;
  TemporaryFolder folder;
  const auto file = folder.path / "token";
  const auto hold = [&](const std::string& token, unsigned mode) {
    std::ofstream(file) << token << '\n';
    std::filesystem::permissions(file, static_cast<perms>(mode));
  };
  hold("a-token-of-the-researcher", 0600);
  EXPECT_EQ(researcher_token(file), "a-token-of-the-researcher");
  for (const unsigned mode : {0622u, 0602u, 0620u, 0666u}) {
    hold("a-token-of-the-researcher", mode);
    EXPECT_NE(complaint_about(file).find("changed by others"), std::string::npos) << mode;
  }
  for (const std::string token :
       {"", "short", "aaaaaaaaaaaaaaaaaaaaaaaa", "abababababababababababab"}) {
    hold(token, 0600);
    EXPECT_NE(complaint_about(file).find("at least 16"), std::string::npos) << token;
  }
}

TEST(Secrets, HoldAtLeast128BitsAndDiffer) {
  std::set<std::string> tokens;
  std::set<std::string> codes;
  for (int i = 0; i < 1000; ++i) {
    tokens.insert(random_token());
    codes.insert(random_code(6));
  }
  EXPECT_EQ(tokens.size(), 1000u);
  EXPECT_EQ(codes.size(), 1000u);
  EXPECT_GE(tokens.begin()->size() * 6, 128u);  // base64: six bits a letter
  EXPECT_EQ(codes.begin()->size(), 35u);        // six groups of five out of 31: 148 bits
  EXPECT_EQ(tokens.begin()->find_first_not_of(
                "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"),
            std::string::npos);
}

TEST(Secrets, CodesAreReadHoweverTheyAreTyped) {
  for (const std::string typed :
       {"AB2CD-EF3GH-J", "ab2cdef3ghj", " Ab2 cd ef3 gh j ", "--aB2Cd--EF3GHJ-"})
    EXPECT_EQ(code_as_written(typed), "AB2CD-EF3GH-J") << typed;
  EXPECT_EQ(code_as_written(""), "");
  EXPECT_EQ(code_as_written(" -\xe2\x80\x93 "), "");  // an en dash as text programs put it
  const auto code = random_code(6);
  EXPECT_EQ(code_as_written(code), code);
}

TEST(Secrets, KeyedDigestIsHmacSha256) {
  // RFC 4231, test case 2.
  EXPECT_EQ(keyed_digest("Jefe", "what do ya want for nothing?"),
            "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
}

TEST(Secrets, AreComparedWhole) {
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abd"));
  EXPECT_FALSE(equal_in_constant_time("abc", "ab"));
  EXPECT_FALSE(equal_in_constant_time("", "a"));
}

}  // namespace
}  // namespace penumbra::server::http
