#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "server/files/digest.h"

namespace penumbra::server::http {

/// `bytes` bytes of the operating system's random source in base64url without padding.
std::string random_token(std::size_t bytes = 24);

/// A random number below 2^53, so that JSON holds it exactly.
std::uint64_t random_seed();

/// A UUID of version 4.
std::string random_uuid();

/// Groups of five letters and digits that can be read aloud (no 0, O, 1, I, L): 24.7 bits a group,
/// so six groups are over 128 bits.
std::string random_code(std::size_t groups);

/// A code of `random_code` as it was given out, from one typed in any case, with any or no dashes
/// and spaces. Characters that no code holds are dropped.
std::string code_as_written(std::string_view typed);

/// Compares in a time that depends on the lengths only.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// The researcher's token: from the file, which is made with a random one where it is missing (mode
/// 0600). Throws Error bad_value (field token_file) for less than 16 characters.
std::string researcher_token(const std::filesystem::path& file);

}  // namespace penumbra::server::http
