// What a study asks of the renderer.
#include <set>

#include "study/study.h"

namespace penumbra::study {

namespace {

using nlohmann::json;

json render_body(const Study& study, const Page& page, const Picture& picture) {
  if (!picture.own.empty()) return {{"picture", picture.own}};
  json body = {{"scene", page.scene},
               {"technique", picture.technique},
               {"parameters", picture.parameters},
               {"width", study.picture.width},
               {"height", study.picture.height},
               {"supersampling", study.picture.supersampling},
               {"light_samples", study.picture.light_samples},
               {"seed", study.picture.seed}};
  if (!page.camera.empty()) body["camera"] = page.camera;
  return body;
}

}  // namespace

PageRenders page_renders(const Study& study, const Page& page) {
  PageRenders renders;
  for (const Picture& picture : page.pictures) {
    renders.pictures.push_back(render_body(study, page, picture));
  }
  if (page.reference == ReferenceUse::shown || page.reference == ReferenceUse::both) {
    renders.shown_reference = render_body(study, page, reference_picture());
  }
  return renders;
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
    for (const json& body : of_page.pictures) add(body);
    if (of_page.shown_reference) add(*of_page.shown_reference);
  };
  if (study.practice) add_page(study.practice->page);
  for (const Page& page : study.pages) add_page(page);
  return renders;
}

}  // namespace penumbra::study
