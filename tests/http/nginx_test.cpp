#include "tests/http/behind_nginx.h"

namespace penumbra::server::http {
namespace {

TEST_F(BehindNginx, TheServiceAnswersAsBefore) {
  body_of(outside->Get("/api/v1/scenes"), 200, "SceneList");
  EXPECT_EQ(error_of(outside->Get("/api/v1/studies"), 401), "unauthorized");
  const auto image = outside->Get("/api/v1/image?scene=boxes&technique=none");
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
    return outside->Post("/api/v1/renders", {{"Origin", origin}}, body.dump(), "application/json");
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
    if (outside->Get("/api/v1/renders/unknown")->status == 429) ++refused;
  EXPECT_GT(refused, 0);
}

TEST_F(BehindNginx, ItsLogHoldsNoTokens) {
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
