#include "server/http/frozen_study.h"

#include "server/files/digest.h"
#include "server/http/reply.h"

namespace penumbra::server::http {
namespace {

const FrozenStudy::PagePictures& pictures_of(const FrozenStudy& frozen,
                                             const study::PlannedPage& planned) {
  return planned.kind == study::PageKind::practice ? frozen.practice : frozen.pages[planned.page];
}

FrozenStudy::PagePictures page_pictures(const study::Study& study, const study::Page& page,
                                        const std::map<std::string, storage::FrozenPicture>& all) {
  const auto renders = study::page_renders(study, page);
  const auto digests_of = [&](const std::vector<nlohmann::json>& views) {
    std::vector<std::string> digests;
    for (const auto& request : views) {
      const auto frozen = all.find(request_key(request));
      digests.push_back(frozen == all.end() ? lost_picture : frozen->second.digest);
    }
    return digests;
  };
  FrozenStudy::PagePictures found;
  for (const auto& views : renders.pictures) found.digests.push_back(digests_of(views));
  found.reference = digests_of(renders.shown_reference);
  return found;
}

}  // namespace

std::string request_key(const nlohmann::json& render_request) {
  return sha256(render_request.dump());
}

study::EnrolmentPlan FrozenStudy::plan(std::size_t place) const {
  const std::lock_guard lock(mutex);
  if (!permutations || permutations->seed != seed) permutations.emplace(seed);
  return study::plan_enrolment(study, *permutations, place);
}

std::vector<std::string> FrozenStudy::picture(const study::PlannedPage& planned,
                                              std::size_t slot) const {
  if (slot >= planned.slots.size()) return {};
  return pictures_of(*this, planned).digests.at(planned.slots[slot]);
}

std::vector<std::string> FrozenStudy::reference(const study::PlannedPage& planned) const {
  return pictures_of(*this, planned).reference;
}

std::shared_ptr<const FrozenStudy> FrozenStudies::of(const storage::StudyRecord& record) {
  const auto key = std::make_pair(record.id, record.version);
  const std::lock_guard lock(mutex);
  if (const auto found = known.find(key); found != known.end()) return found->second;
  auto frozen = std::make_shared<FrozenStudy>();
  frozen->study = study::parse_study(record.document);
  frozen->hash = record.hash;
  frozen->version = record.version;
  frozen->seed = record.seed;
  const auto pictures = studies.pictures(record.id, record.version);
  for (const auto& page : frozen->study.pages)
    frozen->pages.push_back(page_pictures(frozen->study, page, pictures));
  if (frozen->study.practice)
    frozen->practice = page_pictures(frozen->study, frozen->study.practice->page, pictures);
  // A draft can change, and so can the pictures of one that is being published.
  if (record.status == "open" || record.status == "closed") known[key] = frozen;
  return frozen;
}

std::shared_ptr<const FrozenStudy> FrozenStudies::of(const std::string& id, int version) {
  {
    const std::lock_guard lock(mutex);
    if (const auto found = known.find({id, version}); found != known.end()) return found->second;
  }
  const auto record = studies.find(id, version);
  if (!record) throw nothing_here();
  return of(*record);
}

}  // namespace penumbra::server::http
