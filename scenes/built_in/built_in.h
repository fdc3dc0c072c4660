#pragma once

#include <string>
#include <vector>

#include "renderer/error.h"
#include "renderer/scene/scene.h"

namespace penumbra::scenes {

/// One entry of the table of built-in scenes; its maker is a pure function.
struct BuiltIn {
  const char* id;
  const char* title;
  const char* description;
  Scene (*make)();
};

/// Survey scenes first, then those for other uses, then analytic ones.
const std::vector<BuiltIn>& built_in_table();

/// Scenes of one kind whose names carry numbers.
struct SceneFamily {
  const char* prefix;
  const char* form;      ///< of their names, for messages
  const char* contents;  ///< what the numbers count
  Scene (*make)(const std::string& name);
};

const std::vector<SceneFamily>& scene_families();

/// The `count` whole numbers after `prefix` in a name, with an x between them. Throws `error` where
/// the name is anything else.
std::vector<int> numbers_of(const std::string& name, const std::string& prefix, std::size_t count,
                            const Error& error);

/// The six scenes of the survey (van Sambeek 2007, 4.1.2).
Scene make_car();
Scene make_boxes();
Scene make_disco_box();
Scene make_island();
Scene make_warehouse_inside();
Scene make_warehouse_outside();

/// Scenes whose shadows are known in closed form, or that break particular techniques.
Scene make_half_plane();
Scene make_three_layers();
Scene make_contact();
Scene make_leaky_box();
Scene make_camera_in_volume();

/// Models that shadow themselves: one of flat parts, one of round ones (Coleman 2006, 5).
Scene make_aircraft();
Scene make_teapot();

/// Out of doors under the sun: many small casters, one large one, thin ones, and very many.
Scene make_trees();
Scene make_village();
Scene make_tower();
Scene make_town();

/// A tank on legs under a spot lamp.
Scene make_water_tower();

/// `count` (1..400) of the aircraft on a square grid, each turned its own way and the smaller the
/// more there are (Coleman 2006, 6.2).
Scene make_fleet(int count);

/// `fleet:<count>`. Throws bad_value (field "scene") naming the range.
Scene make_named_fleet(const std::string& name);

/// `sweep:<objects>x<triangles>x<lights>` (van Sambeek 2007, 4.1.1). Throws bad_value (field
/// "scene") naming the ranges.
Scene make_sweep(const std::string& name);

}  // namespace penumbra::scenes
