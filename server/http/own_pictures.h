#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

namespace penumbra::server::http {

struct Service;

/// A study's JSON at most, bytes.
inline constexpr std::size_t largest_study = 4 << 20;

/// The study document of a zip that holds `study.json`, at its root or in its one folder, and
/// pictures. Where the document names a file, that picture is stored and its SHA-256 put in the
/// name's place. Throws unreadable for what is no such zip, StudyFaults naming every element whose
/// picture is missing or cannot be read.
nlohmann::json study_of_zip(Service& service, const std::string& zip);

}  // namespace penumbra::server::http
