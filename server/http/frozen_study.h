#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/storage/studies.h"
#include "study/enrolment.h"
#include "study/study.h"

namespace penumbra::server::http {

inline constexpr const char* lost_picture = "lost";

/// A version, parsed once where it is published: what participants are served from.
struct FrozenStudy {
  study::Study study;
  std::string hash;
  int version = 1;
  std::uint64_t seed = 0;

  /// What the person at a place is shown, and in which order. Thread-safe.
  study::EnrolmentPlan plan(std::size_t place) const;

  /// By view, SHA-256 of the picture at a slot, or `lost_picture` in a draft and where the
  /// database's row is damaged; empty where there is no such slot.
  std::vector<std::string> picture(const study::PlannedPage& planned, std::size_t slot) const;
  /// By view, SHA-256 of the reference shown beside the pictures; empty where none is.
  std::vector<std::string> reference(const study::PlannedPage& planned) const;

  struct PagePictures {
    std::vector<std::vector<std::string>> digests;  ///< by picture in the page's order, and view
    std::vector<std::string> reference;             ///< by view
  };
  std::vector<PagePictures> pages;
  PagePictures practice;

 private:
  mutable std::mutex mutex;
  mutable std::optional<study::Permutations> permutations;
};

/// Name of a render request in the table of frozen pictures.
std::string request_key(const nlohmann::json& render_request);

/// Frozen studies by id and version. Thread-safe.
class FrozenStudies {
 public:
  explicit FrozenStudies(storage::Studies& studies_) : studies(studies_) {}

  std::shared_ptr<const FrozenStudy> of(const storage::StudyRecord& record);
  /// Throws not_found.
  std::shared_ptr<const FrozenStudy> of(const std::string& id, int version);

 private:
  storage::Studies& studies;
  std::mutex mutex;
  std::map<std::pair<std::string, int>, std::shared_ptr<const FrozenStudy>> known;
};

}  // namespace penumbra::server::http
