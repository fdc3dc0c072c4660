#include "experiments/recommend/measured.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <span>

#include "experiments/engine/engine.h"
#include "renderer/embedded_file.h"
#include "renderer/error.h"
#include "scenes/json_text.h"
#include "study/csv.h"

namespace penumbra::experiments::recommend {

std::span<const EmbeddedFile> embedded_measurements();  // measured-*.csv

namespace {

using nlohmann::json;

/// Places of the columns that are read.
class Columns {
 public:
  explicit Columns(const std::vector<std::string>& head) : head_(head) {}

  const std::string& text(const study::CsvRecord& record, const std::string& name) const {
    const auto found = std::find(head_.begin(), head_.end(), name);
    const auto place = static_cast<std::size_t>(found - head_.begin());
    if (found == head_.end() || place >= record.cells.size())
      throw Error("unreadable",
                  "line " + std::to_string(record.line) + " of the results has no " + name, "from");
    return record.cells[place];
  }

  double number(const study::CsvRecord& record, const std::string& name) const {
    const std::string& cell = text(record, name);
    double value = 0.0;
    const auto [end, fault] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (fault != std::errc() || end != cell.data() + cell.size())
      throw Error("unreadable",
                  "line " + std::to_string(record.line) + " of the results: " + name +
                      " must be a number, not '" + cell + "'",
                  "from");
    return value;
  }

 private:
  std::vector<std::string> head_;
};

MeasuredScene& scene_of(Measured& measured, const std::string& scene, int size) {
  for (MeasuredScene& known : measured.scenes)
    if (known.scene == scene && known.size == size) return known;
  MeasuredScene fresh;
  fresh.scene = scene;
  fresh.size = size;
  return measured.scenes.emplace_back(fresh);
}

const char* kind_of_device(bool gpu) {
  return gpu ? "gpu" : "cpu";
}

const EmbeddedFile* file_of(bool gpu) {
  for (const EmbeddedFile& file : embedded_measurements())
    if (file.path.find(std::string("measured-") + kind_of_device(gpu)) != std::string_view::npos)
      return &file;
  return nullptr;
}

}  // namespace

std::vector<std::string> Measured::candidates() const {
  std::set<std::string> names;
  for (const MeasuredScene& scene : scenes)
    for (const auto& [name, known] : scene.candidates) names.insert(name);
  return {names.begin(), names.end()};
}

std::string candidate_name(const std::string& id, const json& given) {
  std::string name = id;
  for (const auto& [parameter, value] : given.items())
    name += ":" + parameter + "=" +
            (value.is_string() ? value.get<std::string>() : scenes::json_text(value));
  return name;
}

void add_results(Measured& measured, std::string_view csv, const std::string& error) {
  Measured fresh;
  study::CsvReader reader(csv);
  study::CsvRecord record;
  if (!reader.next(record)) throw Error("unreadable", "the results are empty", "from");
  const Columns columns(record.cells);
  const std::string without = technique_of_family("none").id;
  while (reader.next(record)) {
    if (columns.text(record, "status") != "done" || columns.text(record, error).empty()) continue;
    const std::string& technique = columns.text(record, "technique");
    const json given = json::parse(columns.text(record, "parameters"), nullptr, false);
    if (!given.is_object())
      throw Error("unreadable",
                  "line " + std::to_string(record.line) +
                      " of the results: parameters must be an "
                      "object",
                  "from");
    const std::string id = technique.substr(0, technique.find(':'));
    // Beside `none` of the same minute, so that clocks and other work cancel.
    const Known known{columns.number(record, error), columns.number(record, "frame_ms_over_none"),
                      columns.number(record, "memory_over_none_bytes")};
    MeasuredScene& scene = scene_of(fresh, columns.text(record, "scene"),
                                    static_cast<int>(columns.number(record, "size")));
    if (id == without)
      scene.none = {known.error, columns.number(record, "frame_ms_median"), 0.0};
    else
      scene.candidates[candidate_name(id, given)] = known;
  }
  for (MeasuredScene& scene : fresh.scenes) {
    if (scene.none.ms <= 0.0 || scene.none.error <= 0.0) continue;
    MeasuredScene& kept = scene_of(measured, scene.scene, scene.size);
    kept.none = scene.none;
    for (auto& [name, known] : scene.candidates) {
      known.ms *= scene.none.ms;
      kept.candidates[name] = known;
    }
  }
}

Measured measured_before(bool gpu, const std::string& error) {
  Measured measured;
  const EmbeddedFile* file = file_of(gpu);
  // Until a GPU was measured, what a processor needed is the better guess than nothing.
  if (file == nullptr) file = file_of(!gpu);
  if (file != nullptr) add_results(measured, file->text, error);
  return measured;
}

}  // namespace penumbra::experiments::recommend
