#include <atomic>

#include "server/http/documents.h"
#include "tests/http/behind_nginx.h"

namespace penumbra::server::http {
namespace {

TEST_F(BehindNginx, TheServiceAnswersAsBefore) {
  body_of(outside->Get("/api/v1/scenes", as_researcher), 200, "SceneList");
  EXPECT_EQ(error_of(outside->Get("/api/v1/studies"), 401), "unauthorized");
  const auto image = outside->Get("/api/v1/image?scene=boxes&technique=none", as_researcher);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->body, FakeRenders::png_of("none"));
  EXPECT_FALSE(image->get_header_value("Strict-Transport-Security").empty());
}

TEST_F(BehindNginx, SessionsAreForEncryptedConnectionsOnly) {
  const auto opened = outside->Get("/lab?token=" + server->token());
  ASSERT_TRUE(opened);
  EXPECT_NE(opened->get_header_value("Set-Cookie").find("Secure"), std::string::npos);
}

TEST_F(BehindNginx, TheSitesOwnOriginIsAccepted) {
  const json body = {{"scene", "boxes"}, {"technique", "none"}};
  const auto from = [&](const std::string& origin) {
    auto headers = as_researcher;
    headers.emplace("Origin", origin);
    return outside->Post("/api/v1/renders", headers, body.dump(), "application/json");
  };
  body_of(from("https://study.example.org"), 200, "Render");
  EXPECT_EQ(error_of(from("https://evil.example"), 403), "forbidden");
}

TEST_F(BehindNginx, LargeBodiesAreForScenesOnly) {
  const std::string large(2 << 20, ' ');
  EXPECT_EQ(outside->Post("/api/v1/renders", large, "application/json")->status, 413);
  EXPECT_EQ(error_of(outside->Put("/api/v1/scenes/mine", large, "application/json"), 401),
            "unauthorized");
}

TEST_F(BehindNginx, FloodsFromOneAddressAreSlowedDown) {
  int refused = 0;
  for (int i = 0; i < 400; ++i)
    if (outside->Get("/api/v1/renders/unknown", as_researcher)->status == 429) ++refused;
  EXPECT_GT(refused, 0);
}

TEST_F(BehindNginx, UploadsWithoutTokenAreKeptNowhere) {
  constexpr std::size_t size = 100 << 20;
  int files = 0;
  const auto result = outside->Put(
      "/api/v1/scenes/mine", {}, size,
      [&](std::size_t, std::size_t length, httplib::DataSink& sink) {
        const std::string block(std::min<std::size_t>(length, 4 << 20), 'x');
        for (const auto& entry : std::filesystem::recursive_directory_iterator(place / "body"))
          if (entry.is_regular_file()) ++files;
        return sink.write(block.data(), block.size());
      },
      "model/gltf-binary");
  // The client may be cut off while it is sending.
  EXPECT_TRUE(!result || result->status == 401);
  EXPECT_EQ(files, 0);
}

TEST_F(BehindNginx, OtherNamesAreNotThisSite) {
  for (const std::string host : {"evil.example", "127.0.0.1", ""}) {
    const auto result = outside->Get("/api/v1/scenes", {{"Host", host}});
    ASSERT_TRUE(result) << host;
    EXPECT_TRUE(result->status == 421 || result->status == 400) << host << result->status;
  }
}

TEST_F(BehindNginx, TellsNoVersion) {
  for (const std::string path : {"/", "/api/v1/scenes/x/../../../%"})
    EXPECT_EQ(outside->Get(path)->get_header_value("Server"), "nginx");
}

TEST_F(BehindNginx, EverythingButParticipantsCallsNeedsTheToken) {
  ASSERT_EQ(publish("thesis-2007"), "open");
  for (const std::string path :
       {"/api/v1/image?scene=boxes&technique=none", "/api/v1/plan?scene=boxes&technique=none",
        "/api/v1/scenes", "/api/v1/techniques", "/api/v1/renders/x", "/api/v1/renders/x/image.png",
        "/openapi.json", "/api/v1/studies", "/api/v1/sweeps/x"})
    EXPECT_EQ(error_of(outside->Get(path), 401), "unauthorized") << path;
  EXPECT_EQ(outside->Get("/s/thesis-2007")->status, 200);
  EXPECT_EQ(outside->Get("/s/thesis-2007/welcome")->status, 200);
}

/// One person's visit; counts every answer that is none.
int refusals_of_a_visit(httplib::SSLClient& browser) {
  int refused = 0;
  const auto get = [&](const std::string& path) {
    const auto result = browser.Get(path);
    if (!result || result->status != 200) ++refused;
  };
  get("/s/thesis-2007");
  get("/s/thesis-2007/welcome");
  for (const auto& file : embedded_pages())
    if (file.path.find("researcher") == std::string::npos)
      get("/assets" + std::string(file.path.substr(std::string_view("web").size())));
  const auto entered =
      browser.Post("/api/v1/studies/thesis-2007/participants", "{}", "application/json");
  if (!entered || entered->status != 201) return refused + 1;
  const auto pages = json::parse(entered->body).at("pages");
  for (std::size_t page = 0; page < 2; ++page)
    for (const auto& image : pages.at(page).at("images")) get(image.at("url").get<std::string>());
  return refused;
}

TEST_F(BehindNginx, ARoomBehindOneAddressIsRefusedNothing) {
  ASSERT_EQ(publish("thesis-2007"), "open");
  std::atomic<int> refused{0};
  std::vector<std::thread> people;
  for (int i = 0; i < 40; ++i)
    people.emplace_back([&] {
      httplib::SSLClient browser("127.0.0.1", port);
      browser.enable_server_certificate_verification(false);
      browser.set_default_headers({{"Host", "study.example.org"}});
      browser.set_keep_alive(true);
      browser.set_read_timeout(60);
      refused += refusals_of_a_visit(browser);
    });
  for (auto& person : people) person.join();
  EXPECT_EQ(refused, 0);
}

TEST_F(BehindNginx, FilesOfPagesAreSentOnce) {
  const auto first = outside->Get("/assets/shared/http.js");
  ASSERT_EQ(first->status, 200);
  const auto tag = first->get_header_value("ETag");
  ASSERT_FALSE(tag.empty());
  const auto again = outside->Get("/assets/shared/http.js", {{"If-None-Match", tag}});
  EXPECT_EQ(again->status, 304);
  EXPECT_TRUE(again->body.empty());
  EXPECT_EQ(again->get_header_value("ETag"), tag);
  EXPECT_NE(outside->Get("/assets/participant/main.js")->get_header_value("ETag"), tag);
}

TEST_F(BehindNginx, ItsLogHoldsNoTokens) {
  outside->Get("/API/v1/Participants/a-persons-token");
  outside->Get("/api/v1/participants/a-persons-token");
  outside->Delete("/api/v1/withdrawals/a-persons-code");
  outside->Get("/lab?token=" + server->token());
  std::string log;
  for (int i = 0; i < 40 && log.find("/lab") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    log = text_of(place / "penumbra.log");
  }
  EXPECT_NE(log.find("GET /api/v1/participants 404"), std::string::npos) << log;
  EXPECT_EQ(log.find("a-persons"), std::string::npos) << log;
  EXPECT_EQ(log.find(server->token()), std::string::npos) << log;
}

}  // namespace
}  // namespace penumbra::server::http
