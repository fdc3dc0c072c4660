// Pictures of the researcher's own: what is taken, what is kept of it, and that nothing tells them
// from rendered ones.
#include <webp/encode.h>

#include <set>

#include "scenes/picture_io.h"
#include "server/http/png.h"
#include "study/csv.h"
#include "tests/http/a_study.h"
#include "tests/http/png_files.h"
#include "tests/http/zip_files.h"

namespace penumbra::server::http {
namespace own_pictures_test {

constexpr std::uint32_t width = 16;
constexpr std::uint32_t height = 8;

/// White on the left, black on the right, with a little green that grows downwards.
Image8 half_and_half(std::uint8_t white = 255) {
  Image8 picture(width, height, 4, 255);
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      for (std::uint32_t c = 0; c < 3; ++c) picture.at(x, y, c) = x < width / 2 ? white : 0;
      picture.at(x, y, 1) = static_cast<std::uint8_t>(picture.at(x, y, 1) / 2 + 8 * y);
    }
  return picture;
}

std::string webp_of(const Image8& picture) {
  std::uint8_t* bytes = nullptr;
  const auto size = WebPEncodeLosslessRGBA(picture.pixels.data(), static_cast<int>(picture.width),
                                           static_cast<int>(picture.height),
                                           static_cast<int>(4 * picture.width), &bytes);
  std::string webp(reinterpret_cast<const char*>(bytes), size);
  WebPFree(bytes);
  return webp;
}

std::string jpeg_of(const Image8& picture) {
  const TemporaryFolder folder;
  const auto file = folder.path / "picture.jpg";
  scenes::write_picture(file, picture);
  return storage::read_file(file);
}

/// The JPEG with an EXIF block of one entry, Orientation (EXIF 2.3, 4.6.4: tag 0x0112), and a text
/// that must never be served.
std::string with_orientation(const std::string& jpeg, char orientation) {
  const std::string tiff("MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0", 19);
  const std::string exif = std::string("Exif\0\0", 6) + tiff + orientation +
                           std::string("\0\0\0\0\0\0", 6) + "secret place";
  const auto length = static_cast<char>(exif.size() + 2);
  return jpeg.substr(0, 2) + "\xff\xe1" + '\0' + length + exif + jpeg.substr(2);
}

class OwnPictures : public AStudy {
 protected:
  using RunningServer::publish;

  httplib::Result upload(const std::string& bytes) {
    return researcher->Post("/api/v1/pictures", bytes, "application/octet-stream");
  }

  json stored(const std::string& bytes) { return body_of(upload(bytes), 201, "OwnPicture"); }

  std::string kept(const json& picture) {
    const auto reply = researcher->Get("/api/v1/pictures/" + picture["picture"].get<std::string>());
    EXPECT_EQ(reply->status, 200);
    EXPECT_EQ(reply->get_header_value("Content-Type"), "image/png");
    return reply->body;
  }

  /// A page of two renders and one's own picture.
  json document(const std::string& picture) {
    auto document = study()["document"];
    document["id"] = "photographs";
    document["picture"] = {{"width", width}, {"height", height}};
    document["pages"] = json::array({{{"scene", "boxes"}}});
    document.erase("repeats");
    document.erase("practice");
    document["techniques"] = json::array(
        {"none", "shadow-map", {{"id", "photo"}, {"picture", picture}, {"label", "PHOTO"}}});
    return document;
  }

  httplib::Result post_study(const std::string& body) {
    return researcher->Post("/api/v1/studies", body, "application/json");
  }

  /// Fields of all faults.
  std::set<std::string> faults_of(const httplib::Result& reply) {
    std::set<std::string> fields;
    const auto body = body_of(reply, 400, "Error");
    for (const auto& fault : body["error"]["errors"])
      fields.insert(fault["field"].get<std::string>());
    return fields;
  }

  std::string get_picture(const std::string& url, const std::string& accept) {
    const auto reply = client->Get(url, {{"Accept", accept}});
    EXPECT_EQ(reply->status, 200) << reply->body;
    return reply->body;
  }

  /// URL of the picture with these pixels among a person's, in the first page.
  std::string url_of(const json& person, const Image8& picture) {
    for (const auto& image : person["pages"][0]["images"]) {
      const auto url = image["url"].get<std::string>();
      if (scenes::decode_picture(get_picture(url, "image/png")).pixels == picture.pixels)
        return url;
    }
    ADD_FAILURE() << "no picture of the page has these pixels";
    return {};
  }
};

TEST_F(OwnPictures, AreKeptAsTheirPixelsAlone) {
  const auto picture = half_and_half();
  auto png = scenes::encode_png(picture);
  png.insert(33, chunk("tEXt", std::string("Author\0somebody", 15)));  // after IHDR
  for (const auto& file : {png, webp_of(picture)}) {
    const auto about = stored(file);
    EXPECT_EQ(about["width"], width);
    EXPECT_EQ(about["height"], height);
    const auto bytes = kept(about);
    EXPECT_EQ(scenes::decode_picture(bytes).pixels, picture.pixels);
    EXPECT_EQ(chunk_types(bytes), (std::vector<std::string>{"IHDR", "IDAT", "IEND"}));
  }
  EXPECT_EQ(stored(png), stored(webp_of(picture)));  // the same pixels are the same picture
}

TEST_F(OwnPictures, OfACameraAreTurnedUprightAndLoseTheirExif) {
  const auto jpeg = jpeg_of(half_and_half());
  // 6: the first row shown on the right, the first column on top (EXIF 2.3, table of 0x0112).
  const auto about = stored(with_orientation(jpeg, 6));
  EXPECT_EQ(about["width"], height);
  EXPECT_EQ(about["height"], width);
  const auto bytes = kept(about);
  EXPECT_EQ(bytes.find("secret"), std::string::npos);
  const auto upright = scenes::decode_picture(bytes);
  EXPECT_GT(upright.at(4, 2, 0), 230);
  EXPECT_LT(upright.at(4, 13, 0), 25);
  // Green grows with the stored row, which 6 shows from right to left.
  EXPECT_GT(upright.at(0, 13, 1), upright.at(7, 13, 1));
  EXPECT_EQ(stored(jpeg)["width"], width);
}

TEST_F(OwnPictures, LieOnThePagesGreyWhereTheyAreTransparent) {
  Image8 picture(2, 1, 4, 255);
  picture.at(1, 0, 3) = 0;
  const auto opaque = scenes::decode_picture(kept(stored(scenes::encode_png(picture))));
  EXPECT_EQ(opaque.pixels, (std::vector<std::uint8_t>{255, 255, 255, 255, 118, 118, 118, 255}));
}

TEST_F(OwnPictures, AreRefusedWhereTheyAreNoneOrTooLarge) {
  const auto png = scenes::encode_png(half_and_half());
  EXPECT_EQ(error_of(upload(""), 400), "bad_value");
  for (const auto& bytes : {std::string("no picture"), png.substr(0, png.size() / 2),
                            std::string("RIFF\x04\0\0\0WEBPVP8L", 16)})
    EXPECT_EQ(error_of(upload(bytes), 422), "unreadable");
  const auto large = scenes::encode_png(Image8(4097, 4097, 1));
  EXPECT_EQ(error_of(upload(large), 422), "unreadable");
  EXPECT_EQ(client->Post("/api/v1/pictures", png, "image/png")->status, 401);
  EXPECT_EQ(researcher->Get("/api/v1/pictures/" + std::string(64, '0'))->status, 404);
  EXPECT_EQ(researcher->Get("/api/v1/pictures/..")->status, 404);
}

TEST_F(OwnPictures, OfAStudyAreNamedWhereTheyDoNotFit) {
  const auto right = stored(scenes::encode_png(half_and_half()))["picture"].get<std::string>();
  const auto wide = stored(scenes::encode_png(Image8(17, 8, 4, 9)))["picture"].get<std::string>();
  EXPECT_EQ(faults_of(post_study(document(std::string(64, 'a')).dump())),
            std::set<std::string>{"techniques[2].picture"});
  EXPECT_EQ(faults_of(post_study(document(wide).dump())),
            std::set<std::string>{"techniques[2].picture"});
  EXPECT_EQ(faults_of(post_study(document("photo.png").dump())),
            std::set<std::string>{"techniques[2].picture"});
  auto both = document(right);
  both["techniques"][2]["technique"] = "pcss";
  EXPECT_EQ(faults_of(post_study(both.dump())), std::set<std::string>{"techniques[2]"});
  auto nameless = document(right);
  nameless["techniques"][2].erase("id");
  EXPECT_EQ(faults_of(post_study(nameless.dump())), std::set<std::string>{"techniques[2].id"});
  auto with_parameters = document(right);
  with_parameters["techniques"][2]["parameters"] = {{"map_size", 3}};
  EXPECT_EQ(faults_of(post_study(with_parameters.dump())),
            std::set<std::string>{"techniques[2].parameters"});
}

TEST_F(OwnPictures, AreShownRankedAndExportedLikeRenders) {
  const auto picture = half_and_half();
  const auto name = stored(scenes::encode_png(picture))["picture"].get<std::string>();
  body_of(post_study(document(name).dump()), 201, "Study");
  const auto preview =
      body_of(researcher->Post("/api/v1/studies/photographs/participants",
                               json{{"preview", true}, {"version", 1}}.dump(), "application/json"),
              201, "Enrolment");
  EXPECT_FALSE(url_of(preview, picture).empty());
  ASSERT_EQ(publish("photographs"), "open");

  const auto person =
      body_of(post("/api/v1/studies/photographs/participants", json::object()), 201, "Enrolment");
  for (const auto& secret : {name, std::string("photo\""), std::string("PHOTO")})
    EXPECT_EQ(person.dump().find(secret), std::string::npos);
  const auto url = url_of(person, picture);
  const auto webp = get_picture(url, "image/webp");
  EXPECT_EQ(webp.substr(0, 4) + webp.substr(8, 4), "RIFFWEBP");
  std::set<std::string> header_names;
  for (const auto& image : person["pages"][0]["images"]) {
    const auto reply = client->Get(image["url"].get<std::string>());
    std::string names;
    for (const auto& [key, value] : reply->headers)
      if (key != "Content-Length" && key != "Date") names += key + "=" + value + "\n";
    header_names.insert(names);
    EXPECT_EQ(chunk_types(reply->body), (std::vector<std::string>{"IHDR", "IDAT", "IEND"}));
  }
  EXPECT_EQ(header_names.size(), 1u);

  body_of(put(page_of(person, 0), answer(person["pages"][0], 1)), 200, "AnswerReply");
  const auto table =
      study::parse_csv(researcher->Get("/api/v1/studies/photographs/responses.csv")->body);
  const auto column = [&](const std::string& wanted) {
    const auto& header = table.front().cells;
    return static_cast<std::size_t>(std::find(header.begin(), header.end(), wanted) -
                                    header.begin());
  };
  int own = 0;
  for (std::size_t row = 1; row < table.size(); ++row) {
    const auto& cells = table[row].cells;
    const bool photo = cells.at(column("technique")) == "photo";
    own += photo ? 1 : 0;
    EXPECT_EQ(cells.at(column("own_picture")), photo ? name : "");
    EXPECT_EQ(cells.at(column("preset")).empty(), photo);
  }
  EXPECT_EQ(own, 1);
}

TEST_F(OwnPictures, TooWideForWebPStayPngForEverybody) {
  // WebP holds 16383 pixels a side (RFC 9649, 2.5), a PNG and a study more.
  const auto wide = [](std::uint8_t grey) {
    Image8 picture(16384, 2, 4, 255);
    for (std::uint32_t x = 0; x < picture.width; ++x)
      for (std::uint32_t c = 0; c < 3; ++c)
        picture.at(x, 1, c) = static_cast<std::uint8_t>(x % grey);
    return picture;
  };
  auto document_of_wide = document("");
  document_of_wide["picture"] = {{"width", 16384}, {"height", 2}};
  document_of_wide["techniques"] = json::array();
  for (const std::uint8_t grey : {100, 200})
    document_of_wide["techniques"].push_back(
        {{"id", "grey-" + std::to_string(grey)},
         {"picture", stored(scenes::encode_png(wide(grey)))["picture"]}});
  document_of_wide["pages"] = json::array({{{"scene", "nowhere"}}});
  body_of(post_study(document_of_wide.dump()), 201, "Study");
  ASSERT_EQ(publish("photographs"), "open");
  const auto person =
      body_of(post("/api/v1/studies/photographs/participants", json::object()), 201, "Enrolment");
  for (const std::uint8_t grey : {100, 200}) {
    const auto url = url_of(person, wide(grey));
    const auto reply = client->Get(url, {{"Accept", "image/webp,*/*"}});
    EXPECT_EQ(reply->get_header_value("Content-Type"), "image/png");
    EXPECT_EQ(reply->get_header_value("Vary"), "Accept");
    EXPECT_EQ(scenes::decode_picture(reply->body).pixels, wide(grey).pixels);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path / "data" / "webp"));
}

TEST_F(OwnPictures, AloneNeedNoScene) {
  const auto first = stored(scenes::encode_png(half_and_half()))["picture"];
  const auto second = stored(scenes::encode_png(half_and_half(200)))["picture"];
  auto alone = document("");
  alone["techniques"] =
      json::array({{{"id", "a"}, {"picture", first}}, {{"id", "b"}, {"picture", second}}});
  alone["pages"] = json::array({{{"scene", "nowhere"}}});
  body_of(post_study(alone.dump()), 201, "Study");
  const int submitted = renders->submitted;
  EXPECT_EQ(publish("photographs"), "open");
  EXPECT_EQ(renders->submitted, submitted);
}

TEST_F(OwnPictures, ComeInAZipWithTheirStudy) {
  const auto picture = half_and_half();
  for (const std::string inner : {"", "my study/"}) {
    const auto zip = zip_of({{inner + "study.json", document("photos/one.webp").dump()},
                             {inner + "photos/one.webp", webp_of(picture)}});
    const auto reply = researcher->Post("/api/v1/studies", zip, "application/zip");
    const auto body = body_of(reply, 201, "Study");
    const json name = body["document"]["techniques"][2]["picture"];
    EXPECT_EQ(scenes::decode_picture(kept({{"picture", name}})).pixels, picture.pixels);
  }
}

TEST_F(OwnPictures, OfAZipAreNamedWhereTheyAreMissingOutsideOrUnreadable) {
  auto wrong = document("photos/none.png");
  wrong["pages"].push_back({{"scene", "island"}, {"techniques", wrong["techniques"]}});
  wrong["pages"][1]["techniques"][2]["picture"] = "../../penumbra.sqlite";
  wrong["pages"].push_back({{"scene", "terrain"}, {"techniques", wrong["techniques"]}});
  wrong["pages"][2]["techniques"][2]["picture"] = "text.png";
  const auto zip = zip_of({{"study.json", wrong.dump()}, {"text.png", "no picture"}});
  EXPECT_EQ(faults_of(researcher->Post("/api/v1/studies", zip, "application/zip")),
            (std::set<std::string>{"techniques[2].picture", "pages[1].techniques[2].picture",
                                   "pages[2].techniques[2].picture"}));
  const auto none = zip_of({{"text.png", "no picture"}});
  EXPECT_EQ(error_of(researcher->Post("/api/v1/studies", none, "application/zip"), 422),
            "unreadable");
  const auto odd = zip_of({{"study.json", R"({"pages": 3, "techniques": {"a": [1]}})"}});
  EXPECT_EQ(error_of(researcher->Post("/api/v1/studies", odd, "application/zip"), 400),
            "bad_value");
}

TEST_F(OwnPictures, ThatWereDamagedAreMadeFromTheUploadAgain) {
  const auto picture = half_and_half();
  const auto name = stored(scenes::encode_png(picture))["picture"].get<std::string>();
  body_of(post_study(document(name).dump()), 201, "Study");
  ASSERT_EQ(publish("photographs"), "open");
  for (const auto& file : std::filesystem::directory_iterator(options.data / "pictures"))
    if (file.path().stem() != name) std::filesystem::remove(file.path());
  const auto person =
      body_of(post("/api/v1/studies/photographs/participants", json::object()), 201, "Enrolment");
  EXPECT_FALSE(url_of(person, picture).empty());
}

}  // namespace own_pictures_test
}  // namespace penumbra::server::http
