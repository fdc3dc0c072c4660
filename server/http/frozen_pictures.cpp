#include "server/http/frozen_pictures.h"

#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include "renderer/error.h"
#include "server/files/digest.h"
#include "server/files/durable_file.h"
#include "server/http/png.h"
#include "server/http/webp.h"
#include "server/storage/data_folder.h"
#include "server/storage/folder_files.h"

namespace penumbra::server::http {

FrozenPictures::FrozenPictures(storage::Studies& studies_, RenderService& renders_,
                               const std::filesystem::path& data)
    : studies(studies_),
      renders(renders_),
      folder(data / storage::pictures_name),
      webp_folder(data / storage::webp_name) {
  for (const auto& each : {folder, webp_folder}) {
    storage::make_private_folder(each);
    storage::sweep_unfinished(each);
  }
}

std::filesystem::path FrozenPictures::file_of(const std::string& digest) const {
  return folder / (digest + ".png");
}

std::optional<FrozenPictures::Signature> FrozenPictures::signature_of(
    const std::string& digest) const {
  struct stat about {};
  if (::stat(file_of(digest).c_str(), &about) != 0) return std::nullopt;
  return Signature{static_cast<long long>(about.st_ino), about.st_size,
                   about.st_mtim.tv_sec * 1'000'000'000LL + about.st_mtim.tv_nsec,
                   about.st_ctim.tv_sec * 1'000'000'000LL + about.st_ctim.tv_nsec,
                   static_cast<long long>(about.st_dev)};
}

std::optional<std::string> FrozenPictures::read_file(const std::string& digest) {
  // The signature is taken first: a file that changes while it is read is read again next time.
  const auto signature = signature_of(digest);
  auto bytes = read_whole(file_of(digest));
  const bool right = signature && bytes && sha256(*bytes) == digest;
  const std::lock_guard lock(mutex);
  if (!right) {
    verified.erase(digest);
    if (wrong.insert(digest).second)
      spdlog::error("the picture {} of a study is {}", digest, bytes ? "altered" : "missing");
    return std::nullopt;
  }
  verified[digest] = *signature;
  wrong.erase(digest);
  return bytes;
}

std::optional<std::string> FrozenPictures::read_stored(const std::string& digest) {
  return signature_of(digest) ? read_file(digest) : std::nullopt;
}

std::string FrozenPictures::freeze(const std::string& png) {
  auto digest = sha256(png);
  if (signature_of(digest) && read_file(digest)) return digest;
  storage::write_file_durably(file_of(digest), png);
  const std::lock_guard lock(mutex);
  wrong.erase(digest);
  return digest;
}

SharedBytes FrozenPictures::source_of(const std::string& render) {
  // One's own picture is kept as it was uploaded, under its name.
  if (!signature_of(render)) return renders.artefact(render, "image.png");
  const auto bytes = read_stored(render);
  return bytes ? std::make_shared<const std::string>(*bytes) : nullptr;
}

std::optional<std::string> FrozenPictures::redraw(const std::string& digest) {
  for (const auto& render : studies.renders_of_picture(digest)) {
    try {
      const auto png = source_of(render);
      if (!png) continue;
      // Studies opened before pictures were packed tightly hold them as they were drawn.
      for (auto& pixels : {packed_tightly(*png), pixels_only(*png)})
        if (sha256(pixels) == digest) return pixels;
      spdlog::error("render {} draws other pixels than when its study was opened", render);
    } catch (const Error& error) {
      spdlog::error("the picture {} cannot be drawn again: {}", digest, error.what());
    }
  }
  return std::nullopt;
}

std::string FrozenPictures::read(const std::string& digest) {
  if (auto bytes = read_file(digest)) return *std::move(bytes);
  auto bytes = redraw(digest);
  if (!bytes) throw Error("storage", "a picture of this study is damaged");
  try {
    freeze(*bytes);
    spdlog::info("the picture {} of a study was drawn again", digest);
  } catch (const Error& error) {
    spdlog::error("the picture {} cannot be kept: {}", digest, error.what());
  }
  return *std::move(bytes);
}

std::optional<std::string> FrozenPictures::read_webp(const std::string& digest) {
  const auto file = webp_folder / (digest + ".webp");
  // The file begins with the SHA-256 of its picture's name and of what follows.
  const auto seal_of = [&](std::string_view webp) { return sha256(digest + std::string(webp)); };
  if (const auto sealed = read_whole(file); sealed && sealed->size() > digest.size()) {
    auto webp = sealed->substr(digest.size());
    if (sealed->starts_with(seal_of(webp))) return webp;
    spdlog::error("the WebP of the picture {} is altered, and is made again", digest);
  }
  auto webp = lossless_webp(read(digest));
  if (!webp) return std::nullopt;
  try {
    storage::write_file_durably(file, seal_of(*webp) + *webp);
  } catch (const Error& error) {
    spdlog::error("the WebP of the picture {} cannot be kept: {}", digest, error.what());
  }
  return webp;
}

void FrozenPictures::check() {
  std::set<std::string> open;
  for (const auto& digest : studies.digests_of_open()) {
    open.insert(digest);
    const auto signature = signature_of(digest);
    {
      const std::lock_guard lock(mutex);
      const auto last = verified.find(digest);
      if (signature && last != verified.end() && last->second == *signature) continue;
    }
    read_file(digest);
  }
  // Pictures of studies that are closed hold up no other study.
  const std::lock_guard lock(mutex);
  std::erase_if(wrong, [&](const auto& digest) { return !open.contains(digest); });
}

std::size_t FrozenPictures::damaged() const {
  const std::lock_guard lock(mutex);
  return wrong.size();
}

}  // namespace penumbra::server::http
