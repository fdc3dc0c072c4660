// People who take part, and people who should not.
#include <sqlite3.h>
#include <zip.h>

#include <set>

#include "tests/faults/answering.h"
#include "tests/faults/ledger.h"

namespace penumbra::faults {
namespace {

namespace fs = std::filesystem;

/// One server with the open study for all of them.
class Survey : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<server::TemporaryFolder>();
    ServerOptions options;
    options.data = folder->path / "data";
    copy_published(options.data);
    server = std::make_unique<ServerProcess>(options);
  }
  static void TearDownTestSuite() {
    server.reset();
    folder.reset();
  }

  static Person somebody() {
    auto client = server->client();
    return enter(client);
  }
  static httplib::Result put(const Person& person, std::size_t page, const json& body) {
    return server->client().Put(person.page(page), body.dump(), "application/json");
  }
  static std::string csv() {
    const auto result = server->researcher().Get(study_at + "/responses.csv");
    EXPECT_TRUE(result && result->status == 200);
    return result ? result->body : "";
  }
  static httplib::Result complete(const Person& person, const json& body) {
    for (std::size_t page = 0; page < person.pages.size(); ++page)
      EXPECT_EQ(put(person, page, person.answer(page, random_uuid()))->status, 200);
    return server->client().Post(person.at() + "/complete", body.dump(), "application/json");
  }
  static std::unique_ptr<server::TemporaryFolder> folder;
  static std::unique_ptr<ServerProcess> server;
};
std::unique_ptr<server::TemporaryFolder> Survey::folder;
std::unique_ptr<ServerProcess> Survey::server;

/// A file inside an archive.
std::string unzipped(const std::string& bytes, const std::string& name) {
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, nullptr);
  zip_t* archive = zip_open_from_source(source, ZIP_RDONLY, nullptr);
  if (archive == nullptr) return "";
  std::string text;
  if (zip_file_t* file = zip_fopen(archive, name.c_str(), ZIP_FL_NODIR)) {
    char buffer[4096];
    for (zip_int64_t count = 0; (count = zip_fread(file, buffer, sizeof buffer)) > 0;)
      text.append(buffer, static_cast<std::size_t>(count));
    zip_fclose(file);
  }
  zip_discard(archive);
  return text;
}

TEST_F(Survey, TextOfSqlIsStoredAsItIs) {
  Fault fault(40, "SQL in comments");
  for (const std::string text :
       {"'); DROP TABLE answers; --", "x' OR '1'='1", "\"; DELETE FROM participants"}) {
    ++fault.tries;
    const auto done = complete(somebody(), {{"comment", text}});
    ASSERT_TRUE(done);
    EXPECT_EQ(done->status, 200) << done->body;
    const auto archive = server->researcher().Get(study_at + "/export.zip");
    ASSERT_TRUE(archive);
    EXPECT_NE(unzipped(archive->body, "responses.json").find(json(text).dump()), std::string::npos)
        << text;
  }
  EXPECT_NE(csv().find("half-plane"), std::string::npos);
  fault.did << "kept word for word";
}

TEST_F(Survey, CellsThatSpreadsheetsRunAreNeutralised) {
  Fault fault(41, "comments and link parameters that begin with = + - @");
  for (const std::string text : {"=1+1", "+1", "-1", "@SUM(A1)", "\t=1+1"}) {
    ++fault.tries;
    EXPECT_EQ(complete(somebody(), {{"comment", text}})->status, 200);
  }
  const auto archive = server->researcher().Get(study_at + "/export.zip");
  ASSERT_TRUE(archive);
  ASSERT_EQ(archive->status, 200);
  // No cell of any table begins with one of them, unless it is a number.
  int cells = 0;
  for (const char* name : {"responses.csv", "participants.csv"}) {
    const auto table = unzipped(archive->body, name);
    EXPECT_FALSE(table.empty());
    std::string cell;
    bool quoted = false;
    for (const char c : table + ",") {
      if (c == '"') {
        quoted = !quoted;
      } else if (!quoted && (c == ',' || c == '\n' || c == '\r')) {
        ++cells;
        char* end = nullptr;
        std::strtod(cell.c_str(), &end);
        const bool number = !cell.empty() && *end == '\0';
        EXPECT_TRUE(cell.empty() || number ||
                    std::string("=+-@\t").find(cell[0]) == std::string::npos)
            << name << ": " << cell;
        cell.clear();
      } else {
        cell += c;
      }
    }
  }
  EXPECT_GT(cells, 100);
  fault.did << cells << " cells of the export looked at";
}

TEST_F(Survey, ScriptsAreTextUnderAStrictPolicy) {
  Fault fault(42, "script in comments and link parameters");
  EXPECT_EQ(complete(somebody(), {{"comment", "<script>alert(1)</script>"}})->status, 200);
  const std::string script = "%3Cscript%3Ealert(1)%3C/script%3E";
  for (const std::string& path :
       {std::string("/s/small"), std::string("/lab"), std::string("/api/v1/scenes"), "/s/" + script,
        "/api/v1/image?scene=" + script}) {
    ++fault.tries;
    const auto result = server->client().Get(path);
    ASSERT_TRUE(result) << path;
    const auto policy = result->get_header_value("Content-Security-Policy");
    EXPECT_NE(policy.find("default-src 'none'"), std::string::npos) << path;
    EXPECT_EQ(policy.find("unsafe"), std::string::npos) << path;
    EXPECT_EQ(result->get_header_value("X-Content-Type-Options"), "nosniff");
    if (result->get_header_value("Content-Type").find("html") != std::string::npos) {
      EXPECT_EQ(result->body.find("alert(1)"), std::string::npos) << path;
    }
  }
  fault.did << "never in a page; the policy runs no inline script";
}

TEST_F(Survey, PostsFromOtherSitesAreRefused) {
  Fault fault(43, "posts that a foreign page makes");
  const auto person = somebody();
  const auto body = person.answer(0, random_uuid()).dump();
  const std::vector<httplib::Headers> foreign = {
      {{"Origin", "https://evil.example"}}, {{"Origin", "null"}},
      {{"Origin", "http://127.0.0.1:1"}},   {{"Origin", "http://127.0.0.1.evil.example"}},
      {{"Sec-Fetch-Site", "cross-site"}},
  };
  for (const auto& headers : foreign) {
    ++fault.tries;
    const auto answer = server->client().Put(person.page(0), headers, body, "application/json");
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 403) << headers.begin()->second;
    ++fault.tries;
    const auto entered =
        server->client().Post(study_at + "/participants", headers, "{}", "application/json");
    ASSERT_TRUE(entered);
    EXPECT_EQ(entered->status, 403) << headers.begin()->second;
  }
  EXPECT_EQ(put(person, 0, json::parse(body))->status, 200);
  fault.did << "403 each; the same without a foreign origin is taken";
}

TEST_F(Survey, DoubleSubmissionsAreOneAnswer) {
  Fault fault(44, "double submit, back, replay");
  const auto person = somebody();
  const auto id = random_uuid();
  const auto body = person.answer(0, id);
  std::mutex mutex;
  std::set<std::string> replies;
  std::vector<std::thread> threads;
  for (int i = 0; i < 30; ++i)
    threads.emplace_back([&] {
      const auto result = put(person, 0, body);
      const std::lock_guard lock(mutex);
      ++fault.tries;
      replies.insert(result && result->status == 200 ? result->body : "failed");
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(replies.size(), 1u);
  EXPECT_FALSE(replies.contains("failed"));
  ++fault.tries;
  EXPECT_EQ(put(person, 0, person.answer(0, id, 1))->status, 409);
  ++fault.tries;
  EXPECT_EQ(put(person, 1, person.answer(1, id))->status, 409);
  fault.doubled = Acknowledged::doubled(*server);
  EXPECT_EQ(fault.doubled, 0);
  fault.did << "one reply for all 30; other content under the same id is 409";
}

TEST_F(Survey, PagesThatAreNotAssignedAndClosedStudiesAreRefused) {
  Fault fault(45, "a page that is not there, a person that is not, an answer of another shape");
  const auto person = somebody();
  const auto good = person.answer(0, random_uuid());
  const auto refused = [&](const std::string& path, const json& body) {
    ++fault.tries;
    const auto result = server->client().Put(path, body.dump(), "application/json");
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->status >= 400 && result->status < 500) << path << body << result->status;
  };
  refused(person.at() + "/pages/99", good);
  refused(person.at() + "/pages/-1", good);
  refused(person.at() + "/pages/0x0", good);
  refused(person.at() + "/pages/18446744073709551616", good);
  refused("/api/v1/participants/" + std::string(32, 'x') + "/pages/0", good);
  for (const auto& [key, value] : std::map<std::string, json>{{"shelves", {{"0", 0}}},
                                                              {"shelves", {{"9", 0}}},
                                                              {"difficulty", 6},
                                                              {"difficulty", "hard"},
                                                              {"answer_id", "no uuid"},
                                                              {"unknown", 1}}) {
    auto bent = good;
    bent[key] = value;
    refused(person.page(0), bent);
  }
  EXPECT_EQ(put(person, 0, good)->status, 200);
  fault.did << "4xx each";
}

TEST_F(Survey, TokensAreLongAndUnknownOnesAllLookAlike) {
  Fault fault(46, "tokens of 200 people, and guesses");
  std::set<std::string> tokens;
  for (const auto& person : enter_many(*server, 200)) {
    ++fault.tries;
    // base64url: six bits a letter.
    EXPECT_GE(person.token.size() * 6, 128u);
    EXPECT_TRUE(tokens.insert(person.token).second);
  }
  std::set<std::string> answers;
  const auto token = *tokens.begin();
  for (const std::string& guess :
       {token.substr(1), token + "x", std::string(32, 'A'), std::string("x")}) {
    ++fault.tries;
    const auto result = server->client().Get("/api/v1/participants/" + guess);
    ASSERT_TRUE(result);
    answers.insert(std::to_string(result->status) + result->body);
  }
  EXPECT_EQ(answers.size(), 1u);
  EXPECT_TRUE(answers.begin()->starts_with("404"));
  fault.did << "all different, at least 128 bits; four guesses, one and the same 404";
}

TEST_F(Survey, TheLogHoldsNoSecrets) {
  Fault fault(47, "tokens and codes in the log");
  const auto person = somebody();
  put(person, 0, person.answer(0, random_uuid()));
  server->client().Get(person.at());
  server->client().Get("/lab?token=" + server->token());
  server->client().Get("/api/v1/participants/a-guess-of-a-token");
  server->client().Delete("/api/v1/withdrawals/" + person.withdrawal_code);
  const auto log = server->log();
  for (const auto& secret :
       {person.token, person.withdrawal_code, server->token(), std::string("a-guess-of-a-token")}) {
    ++fault.tries;
    EXPECT_EQ(log.find(secret), std::string::npos);
  }
  EXPECT_NE(log.find("/api/v1/participants/{token}"), std::string::npos);
  fault.did << "none";
}

TEST_F(Survey, WhoWithdrawsLeavesNothingBehind) {
  Fault fault(0, "withdrawal: token, code and pseudonym anywhere in the data folder");
  std::vector<Person> leaving = enter_many(*server, 8);
  std::vector<std::string> names;
  for (const auto& person : leaving) {
    EXPECT_EQ(put(person, 0, person.answer(0, random_uuid()))->status, 200);
    ++fault.tries;
    EXPECT_EQ(server->client().Delete("/api/v1/withdrawals/" + person.withdrawal_code)->status,
              204);
  }
  int found = 0;
  const auto look = [&] {
    found = 0;
    for (const auto& entry : fs::recursive_directory_iterator(server->data())) {
      if (!entry.is_regular_file()) continue;
      std::ifstream file(entry.path(), std::ios::binary);
      std::ostringstream bytes;
      bytes << file.rdbuf();
      for (const auto& person : leaving)
        for (const auto& secret : {person.token, person.withdrawal_code})
          if (bytes.str().find(secret) != std::string::npos) ++found;
    }
    return found == 0;
  };
  EXPECT_TRUE(eventually(look, 10)) << found;
  fault.did << found << " of " << 2 * leaving.size() << " strings left";
}

TEST_F(Survey, TwoTabsLeaveOneCurrentAnswer) {
  Fault fault(49, "30 tabs answer one page under ids of their own");
  const auto person = somebody();
  std::vector<std::thread> tabs;
  std::atomic<int> taken = 0;
  for (int i = 0; i < 30; ++i)
    tabs.emplace_back([&, turn = i] {
      const auto result = put(person, 0, person.answer(0, random_uuid(), turn % 3));
      ++fault.tries;
      if (result && result->status == 200) ++taken;
    });
  for (auto& tab : tabs) tab.join();
  EXPECT_EQ(taken, 30);
  fault.doubled = Acknowledged::doubled(*server);
  EXPECT_EQ(fault.doubled, 0);
  fault.did << "all taken, one of them current in the export";
}

TEST_F(Survey, WithdrawalUnderAReaderHoldsNobodyUp) {
  Fault fault(0, "withdrawal while another process reads the database");
  const auto leaving = enter_many(*server, 3);
  const auto staying = enter_many(*server, 3);
  sqlite3* reader = nullptr;
  ASSERT_EQ(sqlite3_open((server->data() / "penumbra.sqlite").c_str(), &reader), SQLITE_OK);
  sqlite3_exec(reader, "BEGIN; SELECT COUNT(*) FROM answers", nullptr, nullptr, nullptr);
  double longest = 0;
  for (std::size_t i = 0; i < leaving.size(); ++i) {
    ++fault.tries;
    EXPECT_EQ(server->client().Delete("/api/v1/withdrawals/" + leaving[i].withdrawal_code)->status,
              204);
    const Stopwatch watch;
    EXPECT_EQ(put(staying[i], 0, staying[i].answer(0, random_uuid()))->status, 200);
    longest = std::max(longest, watch.seconds());
  }
  sqlite3_exec(reader, "COMMIT", nullptr, nullptr, nullptr);
  sqlite3_close(reader);
  EXPECT_LT(longest, 2.0);
  // Once the reader is gone the log is emptied, by and by.
  const auto gone = [&] {
    for (const char* name : {"penumbra.sqlite", "penumbra.sqlite-wal"}) {
      std::ifstream file(server->data() / name, std::ios::binary);
      std::ostringstream bytes;
      bytes << file.rdbuf();
      for (const auto& person : leaving)
        if (bytes.str().find(person.token) != std::string::npos) return false;
    }
    return true;
  };
  EXPECT_TRUE(eventually(gone, 20));
  fault.did << "answers meanwhile took at most " << static_cast<int>(longest * 1000)
            << " ms; nothing left afterwards";
}

TEST_F(Survey, AChangedStudyIsANewVersionAndAClosedOneTakesNothing) {
  Fault fault(48, "a study that changes after it opened, and is closed");
  const auto person = somebody();
  EXPECT_EQ(put(person, 0, person.answer(0, random_uuid()))->status, 200);
  const auto before = json::parse(server->researcher().Get(study_at)->body);
  auto changed = small_study();
  changed["title"] = {{"en", "Other words"}};
  changed["grace_minutes"] = 0;
  publish(*server, changed);
  const auto after = json::parse(server->researcher().Get(study_at)->body);
  ++fault.tries;
  EXPECT_NE(before["hash"], after["hash"]);
  EXPECT_EQ(after["version"].get<int>(), before["version"].get<int>() + 1);
  const auto next = somebody();
  EXPECT_EQ(put(next, 0, next.answer(0, random_uuid()))->status, 200);
  EXPECT_NE(csv().find(after["hash"].get<std::string>()), std::string::npos);
  EXPECT_EQ(csv().find(before["hash"].get<std::string>()), std::string::npos);
  ++fault.tries;
  EXPECT_LT(server->researcher().Post(study_at + "/close", "", "application/json")->status, 300);
  EXPECT_EQ(put(next, 1, next.answer(1, random_uuid()))->status, 409);
  auto client = server->client();
  EXPECT_TRUE(enter(client).token.empty());
  fault.did << "another version and hash in every row; closed: 409";
}

}  // namespace
}  // namespace penumbra::faults
