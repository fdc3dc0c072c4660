#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "renderer/error.h"
#include "scenes/import/obj.h"
#include "scenes/json_reader.h"
#include "scenes/text.h"

namespace penumbra::scenes::obj {
namespace {

using Words = std::vector<std::string_view>;

std::string line_text(std::size_t line) {
  return "line " + std::to_string(line);
}

/// Statements that say nothing about a surface's shape or colour.
const std::set<std::string_view> silent = {"s",          "mg",        "bevel",  "c_interp",
                                           "d_interp",   "lod",       "maplib", "usemap",
                                           "shadow_obj", "trace_obj", "call"};

const glm::vec3 no_color(-1.0f);

class Reader {
 public:
  explicit Reader(Notes& notes_) : notes(notes_) {}

  void take(const Words& words, std::size_t line) {
    const std::string_view key = words[0];
    if (key == "v") {
      position(words, line);
    } else if (key == "vt") {
      const std::vector<double> values = numbers(words, 1, line, 1, 3);
      file.uvs.emplace_back(values[0], values.size() > 1 ? values[1] : 0.0);
    } else if (key == "vn") {
      const std::vector<double> values = numbers(words, 1, line, 3, 3);
      file.normals.emplace_back(values[0], values[1], values[2]);
    } else if (key == "f" || key == "fo") {
      face(words, line);
    } else if (key == "o" || key == "g") {
      file.shapes.push_back({rest_of(words, 1), {}});
    } else if (key == "usemtl") {
      use_material(rest_of(words, 1));
    } else if (key == "mtllib") {
      file.material_libraries.push_back(rest_of(words, 1));
    } else if (key == "l" || key == "p") {
      notes.add(line_text(line),
                key == "l" ? " is a line: it is left out" : " is a point: it is left out");
    } else if (silent.count(key) == 0) {
      notes.add(line_text(line), ": " + in_quotes(std::string(key)) + " is left out");
    }
  }

  /// Some tools write colours as 0..255.
  void scale_colors() {
    float most = 0.0f;
    for (const glm::vec3& color : file.colors) most = std::max({most, color.x, color.y, color.z});
    if (most <= 1.0f) return;
    for (glm::vec3& color : file.colors)
      if (color != no_color) color /= 255.0f;
    notes.add("", "colours of vertices were read as 0..255");
  }

  File file;

 private:
  static std::vector<double> numbers(const Words& words, std::size_t first, std::size_t line,
                                     std::size_t least, std::size_t most) {
    std::vector<double> values;
    for (std::size_t i = first; i < words.size() && values.size() < most; ++i)
      values.push_back(number_of(words[i], line));
    if (values.size() < least)
      throw unreadable(line_text(line) + ": " + std::string(words[0]) + " needs " +
                       std::to_string(least) + " numbers");
    return values;
  }

  void position(const Words& words, std::size_t line) {
    const std::vector<double> values = numbers(words, 1, line, 3, 8);
    for (std::size_t c = 0; c < 3; ++c)
      if (std::abs(values[c]) > max_coordinate)
        throw unreadable(line_text(line) + ": " + in_quotes(std::string(words[c + 1])) +
                         " is beyond 1e15 metres");
    file.positions.emplace_back(values[0], values[1], values[2]);
    // x y z r g b, or with a weight before the colour; a weight alone belongs to curves.
    if (values.size() < 6 && file.colors.empty()) return;
    file.colors.resize(file.positions.size(), no_color);
    if (values.size() < 6) return;
    const std::size_t first = values.size() == 6 ? 3 : 4;
    for (int c = 0; c < 3; ++c)
      file.colors.back()[c] = static_cast<float>(values[first + static_cast<std::size_t>(c)]);
  }

  /// Index from 1, or from the end where negative; -1 where there is none to read.
  int index_of(std::string_view text, std::size_t count, std::string_view word, std::size_t line) {
    if (text.empty()) return -1;
    if (text.front() == '+') text.remove_prefix(1);
    std::int64_t given = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), given);
    if (error != std::errc{} || stop != text.data() + text.size())
      throw unreadable(line_text(line) + ": " + in_quotes(std::string(word)) +
                       " is no corner of a face");
    const std::int64_t index = given > 0 ? given - 1 : static_cast<std::int64_t>(count) + given;
    if (given == 0 || index < 0 || index >= static_cast<std::int64_t>(count)) return -2;
    return static_cast<int>(index);
  }

  Corner corner_of(std::string_view word, std::size_t line) {
    std::string_view parts[3];
    std::size_t at = 0;
    for (std::string_view& part : parts) {
      if (at > word.size()) break;
      const std::size_t end = std::min(word.find('/', at), word.size());
      part = word.substr(at, end - at);
      at = end + 1;
    }
    Corner corner{index_of(parts[0], file.positions.size(), word, line),
                  index_of(parts[1], file.uvs.size(), word, line),
                  index_of(parts[2], file.normals.size(), word, line)};
    if (corner.position < 0)
      throw unreadable(line_text(line) + ": a face has the vertex " +
                       in_quotes(std::string(parts[0])) + " of " +
                       std::to_string(file.positions.size()));
    for (int* index : {&corner.uv, &corner.normal}) {
      if (*index != -2) continue;
      notes.add(line_text(line), " names a texture coordinate or normal that is not there");
      *index = -1;
    }
    return corner;
  }

  void face(const Words& words, std::size_t line) {
    const std::size_t first = file.corners.size();
    for (std::size_t i = 1; i < words.size(); ++i)
      file.corners.push_back(corner_of(words[i], line));
    if (words.size() < 4) {
      notes.add(line_text(line), " has a face of less than three corners: it is left out");
      file.corners.resize(first);
      return;
    }
    if (file.shapes.empty()) file.shapes.emplace_back();
    file.shapes.back().faces.push_back({first, words.size() - 1, material});
  }

  void use_material(const std::string& name) {
    const auto [entry, added] =
        known.try_emplace(name, static_cast<int>(file.material_names.size()));
    if (added) file.material_names.push_back(name);
    material = entry->second;
  }

  Notes& notes;
  std::map<std::string, int> known;
  int material = -1;
};

}  // namespace

File read_file(std::string_view text, Notes& notes) {
  Reader reader(notes);
  for_each_statement(text, [&](const std::vector<std::string_view>& words, std::size_t line) {
    reader.take(words, line);
  });
  reader.scale_colors();
  // Where only some positions have a colour, the others are white.
  if (!reader.file.colors.empty())
    reader.file.colors.resize(reader.file.positions.size(), no_color);
  for (glm::vec3& color : reader.file.colors)
    if (color == no_color) color = glm::vec3(1.0f);
  return std::move(reader.file);
}

}  // namespace penumbra::scenes::obj
