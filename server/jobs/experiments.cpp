#include "server/jobs/experiments.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <regex>

#include "renderer/error.h"
#include "scenes/json_text.h"
#include "server/files/durable_file.h"
#include "server/jobs/child_process.h"

namespace penumbra::server {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;
using std::chrono::steady_clock;

constexpr std::size_t most_waiting = 32;
/// As a request's study: the ranks that were published in 2007.
constexpr auto published_study = "published";

/// What people ranked in a study, in the folder of an experiment that asks for it.
constexpr auto results_name = "study.json";

constexpr std::size_t most_output = std::size_t{16} << 20;  ///< bytes of a child's summary

/// A key of a request, and how the command takes it.
enum class Form { scene, list, text, number, flag, study };
struct Key {
  const char* name;
  const char* flag;
  Form form;
  const char* example = "";  ///< of a value, shown where people fill it in
};
struct Kind {
  const char* name;
  const char* title;  ///< as people choose it
  std::vector<Key> keys;
  bool imports = true;  ///< whether it takes the folder of imported scenes
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {"sweep",
       "Cost over scenes and sizes",
       {{"scenes", "--scenes", Form::list, "sweep:*x1600x3, boxes"},
        {"techniques", "--techniques", Form::list, "shadow-map, pcss:map_size=1024"},
        {"sizes", "--sizes", Form::list, "300, 600"},
        {"run_ms", "--run-ms", Form::number, "200 of timed frames"},
        {"light_samples", "--light-samples", Form::number, "256 of the reference"},
        {"errors", "--errors", Form::flag}}},
      {"tradeoff",
       "Error against time",
       {{"scene", "", Form::scene, "boxes"},
        {"techniques", "--techniques", Form::list, "shadow-map, pcss:map_size=1024"},
        {"size", "--size", Form::number, "256 pixels an edge"},
        {"run_ms", "--run-ms", Form::number, "200 of timed frames"},
        {"light_samples", "--light-samples", Form::number, "256 of the reference"},
        {"bias", "--bias", Form::flag},
        {"study", "--study", Form::study, "thesis-2007, a study of this server, or published"}}},
      {"recommend",
       "Which technique for a scene",
       {{"scene", "", Form::scene, "boxes"},
        {"budget_ms", "--budget-ms", Form::number, "4.5 a frame"},
        {"memory_bytes", "--memory-bytes", Form::number, "16777216"},
        {"objective", "--objective", Form::text, "rms, flip, worst or perceived"},
        {"study", "--study", Form::study, "thesis-2007, for perceived; otherwise published"},
        {"size", "--size", Form::number, "256 pixels an edge"},
        {"run_ms", "--run-ms", Form::number, "200 of timed frames"},
        {"light_samples", "--light-samples", Form::number, "256 of the reference"}}},
      {"claims",
       "What was published",
       {{"only", "--only", Form::list, "Q05, C23"},
        {"quick", "--quick", Form::flag},
        {"run_ms", "--run-ms", Form::number, "200 of timed frames"}}},
      {"stability",
       "Where numbers break",
       {{"techniques", "--techniques", Form::list, "shadow-map, pcss:map_size=1024"},
        {"axes", "--axes", Form::list, "ground, zoom"}},
       false}};
  return all;
}

/// The kind that a request names, or null.
const Kind* kind_of(const json& request) {
  for (const Kind& kind : kinds())
    if (request.value("kind", json(nullptr)) == kind.name) return &kind;
  return nullptr;
}

/// Text of names and parameters alone: no path, no option.
std::string checked_text(const std::string& field, const json& value) {
  static const std::regex allowed("[A-Za-z0-9_][A-Za-z0-9_:*?=.,+ -]*");
  const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (!std::regex_match(text, allowed) || text.find("..") != std::string::npos)
    throw bad_value(field, field + " takes names of letters, digits and _ : * ? = . + -");
  return text;
}

std::string checked_list(const std::string& field, const json& value) {
  if (!value.is_array()) return checked_text(field, value);
  std::string list;
  for (const json& entry : value) {
    if (entry.is_structured()) throw bad_value(field, field + " is a list of names");
    list += (list.empty() ? "" : ",") + checked_text(field, entry);
  }
  if (list.empty()) throw bad_value(field, field + " names nothing");
  return list;
}

void add_argument(std::vector<std::string>& arguments, const Key& key, const json& value,
                  const fs::path& results) {
  const std::string name = key.name, flag = key.flag;
  if (key.form == Form::flag) {
    if (!value.is_boolean()) throw bad_value(name, name + " must be true or false");
    if (value.get<bool>()) arguments.push_back(flag);
  } else if (key.form == Form::study) {
    if (!value.is_string()) throw bad_value(name, name + " must be a study's id");
    checked_text(name, value);
    arguments.push_back(flag + "=" +
                        (value == published_study ? value.get<std::string>() : results.string()));
  } else if (key.form == Form::number) {
    if (!value.is_number()) throw bad_value(name, name + " must be a number");
    arguments.push_back(flag + "=" + value.dump());
  } else if (key.form == Form::scene) {
    if (!value.is_string()) throw bad_value(name, name + " must be a scene's name");
    const std::string scene = checked_text(name, value);
    // Files have an ending, ids have none.
    if (scene.find('.') != std::string::npos)
      throw bad_value(name, name + " must be the id of a built-in or imported scene, no file");
    arguments.insert(arguments.begin() + 1, scene);
  } else {
    const std::string list = checked_list(name, value);
    if (name == "scenes" && list.find('.') != std::string::npos)
      throw bad_value(name, name + " must be ids of built-in or imported scenes, no files");
    arguments.push_back(flag + "=" + list);
  }
}

json json_file(const fs::path& file) {
  const auto text = read_whole(file);
  return text ? json::parse(*text, nullptr, false) : json(nullptr);
}

/// Reads what the child prints until it ends. False where `goes_on` ended it.
bool wait_for(ChildProcess& child, const std::function<bool()>& goes_on, std::string& output) {
  while (goes_on()) {
    pollfd ready{child.output(), POLLIN, 0};
    if (::poll(&ready, 1, 200) <= 0) continue;
    char piece[4096];
    const ssize_t count = ::read(child.output(), piece, sizeof piece);
    if (count <= 0) return true;
    if (output.size() < most_output) output.append(piece, static_cast<std::size_t>(count));
  }
  return false;
}

}  // namespace

json experiment_kinds() {
  json list = json::array();
  for (const Kind& kind : kinds()) {
    json keys = json::array();
    for (const Key& key : kind.keys)
      keys.push_back({{"name", key.name},
                      {"form", key.form == Form::flag     ? "flag"
                               : key.form == Form::number ? "number"
                                                          : "text"},
                      {"required", key.form == Form::scene},
                      {"example", key.example}});
    list.push_back({{"kind", kind.name}, {"title", kind.title}, {"keys", keys}});
  }
  return list;
}

std::optional<std::string> study_of_experiment(const json& request) {
  experiment_arguments(request);
  for (const Key& key : kind_of(request)->keys)
    if (key.form == Form::study && request.contains(key.name) &&
        request.at(key.name) != published_study)
      return request.at(key.name).get<std::string>();
  return {};
}

std::vector<std::string> experiment_arguments(const json& request, const fs::path& folder) {
  if (!request.is_object()) throw bad_value("body", "must be an object");
  const Kind* kind = kind_of(request);
  if (kind == nullptr) {
    std::string names;
    for (const Kind& each : kinds()) names += (names.empty() ? "" : ", ") + std::string(each.name);
    throw bad_value("kind", "kind must be one of " + names);
  }
  std::vector<std::string> arguments{kind->name};
  for (const auto& [name, value] : request.items()) {
    if (name == "kind") continue;
    const auto key = std::find_if(kind->keys.begin(), kind->keys.end(),
                                  [&, &wanted = name](const Key& k) { return wanted == k.name; });
    if (key == kind->keys.end())
      throw bad_value(name, "unknown key '" + name + "' of an experiment of this kind");
    add_argument(arguments, *key, value, folder / results_name);
  }
  for (const Key& key : kind->keys)
    if (key.form == Form::scene && !request.contains(key.name))
      throw bad_value(key.name, std::string(key.name) + " is missing");
  return arguments;
}

Experiments::Experiments(ExperimentOptions options) : options_(std::move(options)) {
  if (options_.program.empty()) options_.program = {"/proc/self/exe"};
  load();
  thread_ = std::thread([this] { work(); });
}

void Experiments::load() {
  std::error_code ignored;
  std::vector<ExperimentState> unfinished;
  for (const auto& entry : fs::directory_iterator(options_.folder, ignored)) {
    const json asked = json_file(entry.path() / "request.json");
    if (!asked.is_object() || !asked.contains("request")) continue;
    const json over = json_file(entry.path() / "over.json");
    ExperimentState state{entry.path().filename().string(),
                          asked.at("request").value("kind", ""),
                          asked.value("created_at", ""),
                          over.is_object() ? over.value("status", "failed") : "queued",
                          asked.at("request"),
                          json_file(entry.path() / "progress.json"),
                          over.is_object() ? over.value("error", json(nullptr)) : json(nullptr)};
    if (!state.over()) unfinished.push_back(state);
    all_[state.id] = std::move(state);
  }
  std::sort(unfinished.begin(), unfinished.end(),
            [](const auto& a, const auto& b) { return a.created_at < b.created_at; });
  for (const ExperimentState& state : unfinished) waiting_.push_back(state.id);
}

ExperimentState Experiments::start(const json& request, const std::string& results,
                                   const std::string& id, const std::string& now) {
  experiment_arguments(request);
  const std::lock_guard lock(mutex_);
  if (stopping_) throw Error("draining", "the server is stopping");
  if (waiting_.size() >= most_waiting)
    throw Error("busy", std::to_string(waiting_.size()) + " experiments wait already");
  const fs::path folder = options_.folder / id;
  fs::create_directories(folder);
  if (!results.empty())
    write_durably(folder / results_name, folder / (std::string(results_name) + ".new"), results);
  write_durably(folder / "request.json", folder / "request.json.new",
                scenes::json_text({{"request", request}, {"created_at", now}}));
  ExperimentState state{id, request.at("kind"), now, "queued", request, nullptr, nullptr};
  all_[id] = state;
  waiting_.push_back(id);
  changed_.notify_all();
  return state;
}

std::optional<ExperimentState> Experiments::find(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = all_.find(id);
  if (found == all_.end()) return std::nullopt;
  if (found->second.status == "running")
    found->second.progress = json_file(options_.folder / id / "progress.json");
  return found->second;
}

std::vector<ExperimentState> Experiments::list() {
  const std::lock_guard lock(mutex_);
  std::vector<ExperimentState> states;
  for (const auto& [id, state] : all_) states.push_back(state);
  std::sort(states.begin(), states.end(), [](const auto& a, const auto& b) {
    return std::tie(b.created_at, b.id) < std::tie(a.created_at, a.id);
  });
  return states;
}

std::optional<ExperimentState> Experiments::wait_change(const std::string& id,
                                                        const ExperimentState& seen,
                                                        double seconds) {
  const auto deadline = steady_clock::now() + std::chrono::duration<double>(seconds);
  while (true) {
    const auto now = find(id);
    if (!now || now->status != seen.status || now->progress != seen.progress || stopping_ ||
        steady_clock::now() >= deadline)
      return now;
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(200));
  }
}

bool Experiments::cancel(const std::string& id) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = all_.find(id);
    if (found == all_.end()) return false;
    if (found->second.over()) return true;
    cancelled_[id] = true;
    const auto place = std::find(waiting_.begin(), waiting_.end(), id);
    if (place == waiting_.end()) return true;  // its thread ends it
    waiting_.erase(place);
  }
  end(id, "stopped", nullptr);
  return true;
}

bool Experiments::is_cancelled(const std::string& id) {
  const std::lock_guard lock(mutex_);
  return cancelled_.contains(id);
}

std::optional<std::string> Experiments::file(const std::string& id, const std::string& name) {
  static const std::regex allowed("results\\.csv|report\\.html|figures/[A-Za-z0-9._-]+\\.svg");
  if (!find(id) || !std::regex_match(name, allowed)) return std::nullopt;
  return read_whole(options_.folder / id / name);
}

void Experiments::work() {
  while (true) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return stopping_ || !waiting_.empty(); });
    if (stopping_) return;
    const std::string id = waiting_.front();
    waiting_.pop_front();
    all_[id].status = "running";
    changed_.notify_all();
    lock.unlock();
    try {
      run(id);
    } catch (const std::exception& error) {
      end(id, "failed", {{"code", "internal"}, {"message", error.what()}, {"field", ""}});
    }
  }
}

void Experiments::run(const std::string& id) {
  std::vector<std::string> command = options_.program;
  const fs::path folder = options_.folder / id;
  const json request = find(id)->request;
  for (const std::string& argument : experiment_arguments(request, folder))
    command.push_back(argument);
  command.insert(command.end(), {"--out=" + folder.string(), "--json"});
  if (kind_of(request)->imports) command.push_back("--data=" + options_.data.string());
  if (!options_.device.empty()) command.push_back("--device=" + options_.device);
  ChildProcess child(command, {});
  std::string output;
  const auto deadline = steady_clock::now() + std::chrono::duration<double>(options_.deadline_s);
  const bool ended = wait_for(
      child, [&] { return !stopping_ && !is_cancelled(id) && steady_clock::now() < deadline; },
      output);
  if (stopping_ && !ended) return;  // it goes on with the next server
  if (!ended) {
    child.kill();
    if (is_cancelled(id)) return end(id, "stopped", nullptr);
    return end(id, "failed",
               {{"code", "deadline"},
                {"message", "the experiment took longer than " +
                                std::to_string(static_cast<long>(options_.deadline_s)) +
                                " s; the same request measures what is missing"},
                {"field", ""}});
  }
  const auto how = child.ended(5.0);
  const json summary = json::parse(output, nullptr, false);
  if (summary.is_object() && summary.contains("error"))
    return end(id, "failed", summary.at("error"));
  if (!summary.is_object())
    return end(id, "failed",
               {{"code", "internal"},
                {"message", "the measuring process " + how.value_or("did not end")},
                {"field", ""}});
  end(id, "done", nullptr);
}

void Experiments::end(const std::string& id, const std::string& status, const json& error) {
  const fs::path folder = options_.folder / id;
  const std::lock_guard lock(mutex_);
  ExperimentState& state = all_[id];
  state.status = status;
  state.error = error;
  state.progress = json_file(folder / "progress.json");
  write_durably(folder / "over.json", folder / "over.json.new",
                scenes::json_text({{"status", status}, {"error", error}}));
  changed_.notify_all();
}

void Experiments::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

}  // namespace penumbra::server
