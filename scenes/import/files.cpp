#include <algorithm>
#include <fstream>

#include "renderer/error.h"
#include "scenes/import/import.h"

namespace penumbra::scenes {
namespace fs = std::filesystem;

namespace {

/// Files beyond it are refused before they are read: larger than 5 million textured triangles need.
constexpr std::uintmax_t max_bytes = std::uintmax_t{3} << 30;

std::string percent_decoded(const std::string& text) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string result;
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

}  // namespace

std::string read_bytes(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    throw not_found("scene", "there is no file " + file.string());
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size > max_bytes) throw unreadable(file.string() + " is larger than 3 GiB");
  std::string bytes(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!stream) throw unreadable("cannot read " + file.string());
  return bytes;
}

fs::path resolve_inside(const fs::path& folder, const std::string& uri, const std::string& what) {
  const auto refuse = [&](const char* why) {
    return unreadable(what + " '" + uri.substr(0, 200) + "' " + why, what);
  };
  const std::string text = percent_decoded(uri);
  if (text.empty() || text.find('\0') != std::string::npos) throw refuse("is no file name");
  if (text.find(':') != std::string::npos || text.find('\\') != std::string::npos ||
      text.front() == '/')
    throw refuse("must name a file beside the scene, not a place elsewhere");
  const fs::path relative(text);
  if (std::find(relative.begin(), relative.end(), "..") != relative.end())
    throw refuse("must not lead out of the scene's folder");
  std::error_code error;
  const fs::path base = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  const fs::path target = fs::weakly_canonical(base / relative, error);
  if (error ||
      std::mismatch(base.begin(), base.end(), target.begin(), target.end()).first != base.end())
    throw refuse("must not lead out of the scene's folder");
  return target;
}

}  // namespace penumbra::scenes
