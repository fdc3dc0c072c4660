#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/report/page.h"

/// What all reports say of measured rows (Engine::measure).
namespace penumbra::experiments {

/// results.csv: a line for each row, columns named as in the results of POST /api/v1/sweeps.
std::string results_csv(const std::vector<nlohmann::json>& rows);

/// Number of a row, or not a number where it has none.
double number_of(const nlohmann::json& row, const char* key);

/// Sum of a number over the row's passes of a name.
double sum_over_passes(const nlohmann::json& row, const std::string& pass, const char* key);

bool is_done(const nlohmann::json& row);

/// The table of all rows.
void add_rows(Page& page, const std::vector<nlohmann::json>& rows);

/// Machine, driver, number of runs, command and date.
void add_facts(Page& page, const nlohmann::json& device, const std::string& command,
               const std::vector<nlohmann::json>& rows);

/// Writes a file of a report. Throws Error `unwritable`, field `out`.
void write_report_file(const std::filesystem::path& file, const std::string& bytes);

/// A name for a file: letters, digits, dots and dashes.
std::string file_name(const std::string& text);

}  // namespace penumbra::experiments
