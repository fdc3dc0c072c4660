// What a study asks of the renderer.
#include <cmath>
#include <numbers>
#include <set>

#include "study/study.h"

namespace penumbra::study {

namespace {

using nlohmann::json;

/// The camera of one view of an orbit.
json camera_of(const Orbit& orbit, int frame) {
  constexpr double radians = std::numbers::pi / 180.0;
  const double azimuth =
      radians * (orbit.from + (orbit.to - orbit.from) * frame / (orbit.frames - 1));
  const double elevation = radians * orbit.elevation;
  const std::array<double, 3> outward{std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                      std::cos(elevation) * std::cos(azimuth)};
  json position = json::array();
  for (std::size_t axis = 0; axis < 3; ++axis)
    position.push_back(orbit.centre[axis] + orbit.distance * outward[axis]);
  return {{"position", position}, {"target", orbit.centre}};
}

json render_body(const Study& study, const Page& page, const Picture& picture) {
  if (!picture.own.empty()) return {{"picture", picture.own}};
  json body = study.picture;
  body["scene"] = page.scene;
  body["technique"] = picture.technique;
  body["parameters"] = picture.parameters;
  if (!page.camera.empty()) body["camera"] = page.camera;
  return body;
}

std::vector<json> views_of(const Study& study, const Page& page, const Picture& picture) {
  std::vector<json> views(page.orbit ? static_cast<std::size_t>(page.orbit->frames) : 1,
                          render_body(study, page, picture));
  if (page.orbit)
    for (std::size_t frame = 0; frame < views.size(); ++frame)
      views[frame]["camera_path"] = json::array({camera_of(*page.orbit, static_cast<int>(frame))});
  return views;
}

}  // namespace

PageRenders page_renders(const Study& study, const Page& page) {
  PageRenders renders;
  for (const Picture& picture : page.pictures) {
    renders.pictures.push_back(views_of(study, page, picture));
  }
  if (page.reference == ReferenceUse::shown || page.reference == ReferenceUse::both) {
    renders.shown_reference = views_of(study, page, reference_picture());
  }
  return renders;
}

std::size_t first_view(const Page& page) {
  return page.orbit ? static_cast<std::size_t>(page.orbit->frames / 2) : 0;
}

std::string own_picture(const json& request) {
  return request.value("picture", "");
}

bool is_picture_name(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::vector<json> all_renders(const Study& study) {
  std::vector<json> renders;
  std::set<std::string> seen;
  const auto add = [&](const json& body) {
    if (seen.insert(body.dump()).second) renders.push_back(body);
  };
  const auto add_page = [&](const Page& page) {
    const PageRenders of_page = page_renders(study, page);
    for (const auto& views : of_page.pictures)
      for (const json& body : views) add(body);
    for (const json& body : of_page.shown_reference) add(body);
  };
  if (study.practice) add_page(study.practice->page);
  for (const Page& page : study.pages) add_page(page);
  return renders;
}

}  // namespace penumbra::study
