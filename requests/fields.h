#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

/// What a request for a picture consists of, and how it is read. Pure functions.
namespace penumbra::requests {

enum class FieldKind {
  text,
  integer,
  real,
  boolean,
  parameters,  ///< of the technique: name to value
  changes,     ///< what a scene's lights or cameras have instead: NAME to key to value
  list         ///< of objects
};

/// Commands that have an option for a field.
enum class Commands { none, all, render, measure };

/// One key of a request, declared once, in declared_fields.cpp. What is accepted, the canonical
/// request, texts (URL queries, options), the command line's help, OpenAPI, a study's schema and
/// settings, and the pages' forms are derived from it.
struct RequestField {
  std::string name;
  FieldKind kind = FieldKind::text;
  std::string meaning;                      ///< one phrase, for help and documents
  std::string more = {};                    ///< further sentences, for documents
  nlohmann::json example = {};              ///< a value of the right form
  bool required = false;                    ///< on the command line: an argument, not an option
  std::optional<double> minimum = {};       ///< of numbers
  std::optional<double> maximum = {};       ///< of numbers; of a list: its entries
  std::vector<std::uint64_t> allowed = {};  ///< of integers, ascending; empty: the whole range
  nlohmann::json default_value = {};        ///< null: none
  std::string default_words = {};           ///< what is taken without a value
  bool pictured = true;                     ///< the picture depends on it
  Commands commands = Commands::all;
  std::string flag = {};           ///< its option; empty: named like the field
  std::string entry = {};          ///< of changes: how one is named in texts, `light.NAME.key`
  nlohmann::json in_studies = {};  ///< default of a study's `picture`; null: not set there
  std::string label = {};          ///< in the researcher's forms; empty: not offered there
};

/// Timed frames of a measurement that names no number.
inline constexpr std::uint32_t default_frames = 9;

/// As declared, in the order in which people read them.
std::vector<RequestField> declared_fields();

/// What this program has: the fields declared.
const std::vector<RequestField>& request_fields();

/// The field of this name, or null.
const RequestField* find_field(const std::string& name);

/// The name with hyphens, as in `--light-samples`, unless the field has a flag of its own.
std::string flag_of(const RequestField& field);

}  // namespace penumbra::requests
