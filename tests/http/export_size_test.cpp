// A large study leaves in little memory. PENUMBRA_EXPORT_PEOPLE=18519 makes it one of a million
// rows and prints how long it took.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>

#include "server/http/study_export.h"
#include "server/storage/database.h"
#include "server/storage/studies.h"
#include "study/simulate.h"
#include "tests/storage/folder.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

/// Resident memory of this process: now, or the most there was. KiB.
long resident(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(name + ":")) return std::stol(line.substr(name.size() + 1));
  return 0;
}

std::string whole(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::shared_ptr<FrozenStudy> thesis_study() {
  auto frozen = std::make_shared<FrozenStudy>();
  frozen->study = study::parse_study(whole(PENUMBRA_SOURCE_DIR "/studies/thesis-2007.json"));
  frozen->hash = study::study_hash(frozen->study);
  frozen->seed = 1;
  return frozen;
}

/// Enrols people and stores their answers; many at a time, so that they share commits.
void fill(storage::Participants& participants, const FrozenStudy& frozen, std::size_t count) {
  const auto people = study::simulate_people(count, count / 10, count / 20, 1);
  const auto preferences = study::default_preferences(frozen.study);
  std::atomic<std::size_t> next{0};
  const auto take_part = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      const std::string name = "P" + std::to_string(i);
      storage::ParticipantRecord fresh;
      fresh.pseudonym = fresh.token = fresh.withdrawal_code = fresh.enrolment_id = name;
      fresh.study = frozen.study.id;
      fresh.language = "en";
      fresh.entered_at = "2026-01-01T10:00:00Z";
      const auto person = participants.enrol(fresh, 0, "2025-01-01");
      const auto plan = frozen.plan(person.place);
      for (std::size_t page = 0; page < plan.pages.size(); ++page) {
        const json body = study::simulate_answer(frozen.study, people[i], plan, page, preferences);
        participants.answer(
            person, {static_cast<int>(page), body.at("answer_id"), body, "2026-01-01T10:01:00Z"},
            [](const json&) { return false; },
            [](const std::string&, int) { return json::object(); });
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 24; ++i) threads.emplace_back(take_part);
  for (auto& thread : threads) thread.join();
}

/// Seconds that `work` takes, printed under its name.
void timed(const std::string& name, const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::cout << name << ": " << seconds.count() << " s\n";
}

TEST(LargeExport, LeavesInLittleMemory) {
  const char* people = std::getenv("PENUMBRA_EXPORT_PEOPLE");
  const std::size_t count = people != nullptr ? std::stoul(people) : 700;  // 37,800 rows
  const TemporaryFolder folder;
  auto frozen = thesis_study();
  storage::Database database(folder.path / "penumbra.sqlite");
  storage::Studies studies(database);
  studies.put_draft(frozen->study.id, frozen->study.document, frozen->seed, "2026-01-01");
  studies.start_publishing(frozen->study.id, 1, frozen->hash, 0);
  studies.open(frozen->study.id, 1, "2026-01-01");
  storage::Participants participants(database);
  fill(participants, *frozen, count);
  frozen = thesis_study();  // as a server that was just started has it
  timed("responses.csv",
        [&] { StudyExport(participants, frozen).write_responses(folder.path / "responses.csv"); });
  StudyExport exported(participants, frozen);
  timed("results.json", [&] { EXPECT_EQ(exported.results().at("participants"), count); });
  std::ofstream("/proc/self/clear_refs") << 5;  // the most there was counts from here
  const long before = resident("VmRSS");
  timed("export.zip",
        [&] { exported.write_archive(folder.path / "export.zip", folder.path / "tmp"); });
  const long growth = resident("VmHWM") - before;
  const auto table = std::filesystem::file_size(folder.path / "responses.csv");
  // The tables together are several times as large; 200 people at a time and some buffers are held.
  EXPECT_GT(table, 8u << 20);
  EXPECT_LT(growth, 16 * 1024) << "KiB";
  EXPECT_TRUE(std::filesystem::is_empty(folder.path / "tmp"));
}

}  // namespace
}  // namespace penumbra::server::http
