#include "tests/faults/people.h"

#include <map>
#include <random>
#include <sstream>

namespace penumbra::faults {

json small_study(const std::string& id) {
  const auto text = [](const std::string& words) { return json{{"en", words}}; };
  json labels = json::array();
  for (const char* step : {"very hard", "hard", "neither", "easy", "very easy"})
    labels.push_back(text(step));
  return {{"id", id},
          {"languages", {"en"}},
          {"title", text("Shadows")},
          {"introduction", text("Two pages.")},
          {"thanks", text("Thank you.")},
          {"consent", {{"version", "1"}, {"text", text("Taking part is voluntary.")}}},
          {"question", text("Order the pictures.")},
          {"labels", {{"most", text("most")}, {"least", text("least")}}},
          {"difficulty", {{"question", text("How hard was it?")}, {"labels", labels}}},
          {"picture", {{"width", 24}, {"height", 24}, {"supersampling", 1}, {"light_samples", 4}}},
          {"techniques", {"none", "shadow-map", "reference"}},
          {"pages", {{{"scene", "half-plane"}}, {{"scene", "boxes"}}}},
          {"completion", {{"code", "SHADE"}, {"url", ""}}}};
}

void publish(const ServerProcess& server, const json& study) {
  auto researcher = server.researcher();
  const auto stored = researcher.Post("/api/v1/studies", study.dump(), "application/json");
  ASSERT_TRUE(stored) << server.log();
  ASSERT_TRUE(stored->status == 201 || stored->status == 200) << stored->body;
  const std::string at = "/api/v1/studies/" + study["id"].get<std::string>();
  ASSERT_TRUE(researcher.Post(at + "/publish", "", "application/json"));
  std::string last;
  ASSERT_TRUE(eventually(
      [&] {
        const auto state = researcher.Get(at);
        if (!state) return false;
        last = state->body;
        return json::parse(last)["status"] == "open";
      },
      120))
      << last;
}

void copy_published(const std::filesystem::path& data) {
  static const server::TemporaryFolder folder;
  static const std::filesystem::path original = [] {
    auto place = folder.path / "data";
    ServerOptions options;
    options.data = place;
    ServerProcess server(options);
    publish(server);
    EXPECT_EQ(server.terminate(), 0) << server.log();
    return place;
  }();
  std::filesystem::copy(original, data, std::filesystem::copy_options::recursive);
}

json slow_render(int width) {
  return {{"scene", "boxes"}, {"technique", "reference"}, {"width", width},
          {"height", 1000},   {"supersampling", 16},      {"light_samples", 65536}};
}

std::string random_uuid() {
  static std::mutex mutex;
  static std::mt19937_64 random(std::random_device{}());
  const std::lock_guard lock(mutex);
  std::ostringstream text;
  const char* digits = "0123456789abcdef";
  for (int i = 0; i < 36; ++i)
    text << (i == 8 || i == 13 || i == 18 || i == 23 ? '-'
             : i == 14                               ? '4'
             : i == 19                               ? '8'
                                                     : digits[random() % 16]);
  return text.str();
}

json Person::answer(std::size_t index, const std::string& id, int turn) const {
  const auto& images = pages.at(index).at("images");
  json shelves;
  for (const auto& image : images) {
    const int slot = image.at("slot");
    shelves[std::to_string(slot)] = (slot + turn) % static_cast<int>(images.size());
  }
  return {{"answer_id", id},
          {"shelves", shelves},
          {"difficulty", 3},
          {"active_ms", 60000},
          {"total_ms", 61000}};
}

Person enter(httplib::Client& client, const std::string& study) {
  const auto result = client.Post(study + "/participants", "{}", "application/json");
  if (!result || result->status != 201) return {};
  const auto body = json::parse(result->body);
  return {body["participant"], body["withdrawal_code"], body["pages"]};
}

void Acknowledged::add(const Person& person, std::size_t page, const std::string& answer,
                       const std::string& reply) {
  EXPECT_EQ(json::parse(reply).at("answer_id"), answer);
  const std::lock_guard lock(mutex);
  answers.push_back({person.token, page, answer});
}

std::size_t Acknowledged::size() const {
  const std::lock_guard lock(mutex);
  return answers.size();
}

int Acknowledged::lost(const ServerProcess& server) const {
  const std::lock_guard lock(mutex);
  auto client = server.client();
  std::map<std::string, json> states;
  int gone = 0;
  for (const auto& answer : answers) {
    if (!states.contains(answer.person)) {
      const auto state = client.Get("/api/v1/participants/" + answer.person);
      states[answer.person] =
          state && state->status == 200 ? json::parse(state->body)["pages"] : json::array();
    }
    const auto& pages = states[answer.person];
    const json kept = answer.page < pages.size() ? pages[answer.page]["answer"] : json();
    if (!kept.is_object() || kept.value("answer_id", "") != answer.id) ++gone;
  }
  return gone;
}

int Acknowledged::doubled(const ServerProcess& server) {
  const auto rows = server.researcher().Get(study_at + "/responses.csv");
  EXPECT_TRUE(rows);
  if (!rows) return -1;
  EXPECT_EQ(rows->status, 200) << rows->body;
  std::istringstream lines(rows->body);
  std::string line;
  std::getline(lines, line);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');) names.push_back(name);
  std::map<std::string, int> counts;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string key;
    std::string cell;
    for (std::size_t i = 0; i < names.size() && std::getline(cells, cell, ','); ++i)
      if (names[i] == "participant" || names[i] == "page_index" || names[i] == "slot")
        key += cell + "/";
    ++counts[key];
  }
  int twice = 0;
  for (const auto& [key, count] : counts)
    if (count > 1) ++twice;
  return twice;
}

}  // namespace penumbra::faults
