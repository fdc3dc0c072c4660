#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/scene.h"
#include "scenes/import/notes.h"
#include "scenes/import/side_files.h"

/// Parts of the OBJ import (Wavefront's "Object Files", appendix B1 of the Advanced Visualizer
/// manual, and what people's tools make of it).
namespace penumbra::scenes::obj {

/// Calls `take` with every statement and the number of its first line: lines joined where one ends
/// in a backslash, comments and blank lines gone.
void for_each_statement(
    std::string_view text,
    const std::function<void(const std::vector<std::string_view>& words, std::size_t line)>& take);

/// The words of a statement from the one at `first` on, as the file has them.
std::string rest_of(const std::vector<std::string_view>& words, std::size_t first);

/// A finite number; a comma may replace the point. Throws unreadable naming the line.
double number_of(std::string_view word, std::size_t line);

/// Which position, uv and normal a corner of a face has; -1 where it has none.
struct Corner {
  int position = -1;
  int uv = -1;
  int normal = -1;
  auto operator<=>(const Corner&) const = default;
};

struct Face {
  std::size_t first = 0;  ///< of File::corners
  std::size_t count = 0;
  int material = -1;  ///< index into File::material_names
};

/// Faces between one o or g and the next.
struct Shape {
  std::string name;
  std::vector<Face> faces;
};

struct File {
  std::vector<glm::dvec3> positions;
  std::vector<glm::vec3> colors;  ///< as long as positions, or empty
  std::vector<glm::dvec2> uvs;
  std::vector<glm::dvec3> normals;
  std::vector<Corner> corners;
  std::vector<Shape> shapes;
  std::vector<std::string> material_names;      ///< as usemtl gives them
  std::vector<std::string> material_libraries;  ///< as mtllib gives them, a line each
};

/// Numbers, references and words checked. Throws unreadable naming the line.
File read_file(std::string_view text, Notes& notes);

/// Fills materials, one per name that the faces use and a grey one behind them, from the material
/// files beside the scene.
void read_materials(const File& file, SideFiles& files, Scene& scene, Notes& notes);

}  // namespace penumbra::scenes::obj
