#pragma once

/// Names of what a data folder holds.
namespace penumbra::server::storage {

inline constexpr const char* database_name = "penumbra.sqlite";
inline constexpr const char* database_log_name = "penumbra.sqlite-wal";
inline constexpr const char* database_index_name = "penumbra.sqlite-shm";
inline constexpr const char* key_name = "integrity.key";
inline constexpr const char* journal_name = "answers.journal";
inline constexpr const char* token_name = "researcher.token";
inline constexpr const char* pictures_name = "pictures";
inline constexpr const char* webp_name = "webp";  ///< derived from pictures: no part of backups

/// Folders of what is being made: uploads and exports.
inline constexpr const char* incoming_name = "incoming";
inline constexpr const char* exports_name = "tmp";

/// What other users must not read.
inline constexpr const char* secret_names[] = {database_name, key_name, journal_name, token_name,
                                               pictures_name};

}  // namespace penumbra::server::storage
