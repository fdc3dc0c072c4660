#include <algorithm>
#include <cctype>
#include <fstream>

#include "renderer/error.h"
#include "scenes/import/import.h"
#include "scenes/text.h"

namespace penumbra::scenes {
namespace fs = std::filesystem;

namespace {

/// Files beyond it are refused before they are read: larger than 5 million textured triangles need.
constexpr std::uintmax_t max_bytes = std::uintmax_t{3} << 30;

/// A name inside the folder as a path. Throws unreadable where it is none.
fs::path checked(const fs::path& folder, const std::string& text, const std::string& shown) {
  const auto refuse = [&](const char* why) { return unreadable(shown + " " + why); };
  if (text.empty() || text.find('\0') != std::string::npos) throw refuse("is no file name");
  if (text.find(':') != std::string::npos || text.find('\\') != std::string::npos ||
      text.front() == '/')
    throw refuse("names a place elsewhere, not a file beside the scene");
  const fs::path relative(text);
  if (std::find(relative.begin(), relative.end(), "..") != relative.end())
    throw refuse("leads out of the scene's folder");
  std::error_code error;
  const fs::path base = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  const fs::path target = fs::weakly_canonical(base / relative, error);
  if (error) throw refuse("is no file name");
  if (std::mismatch(base.begin(), base.end(), target.begin(), target.end()).first != base.end())
    throw refuse("leads out of the scene's folder");
  return target;
}

}  // namespace

std::string percent_decoded(const std::string& text) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 &&
        digit(text[i + 2]) >= 0) {
      result += static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2]));
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

std::string lower_extension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string read_bytes(const fs::path& file) {
  std::error_code error;
  const std::string name = in_quotes(file.filename().string());
  if (!fs::is_regular_file(file, error)) throw not_found("scene", "there is no file " + name);
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size > max_bytes) throw unreadable(name + " is larger than 3 GiB");
  std::string bytes(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!stream) throw unreadable("cannot read " + name);
  return bytes;
}

fs::path resolve_inside(const fs::path& folder, const std::string& name, const std::string& what) {
  const std::string shown = what + " " + in_quotes(name);
  try {
    const fs::path decoded = checked(folder, percent_decoded(name), shown);
    std::error_code ignored;
    if (fs::is_regular_file(decoded, ignored)) return decoded;
    // A file may have a % in its name.
    return checked(folder, name, shown);
  } catch (const Error& error) {
    throw unreadable(error.what(), what);
  }
}

}  // namespace penumbra::scenes
