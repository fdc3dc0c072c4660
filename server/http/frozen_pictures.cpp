#include "server/http/frozen_pictures.h"

#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include "renderer/error.h"
#include "server/http/png.h"
#include "server/jobs/digest.h"
#include "server/jobs/durable_file.h"
#include "server/storage/data_folder.h"

namespace penumbra::server::http {

FrozenPictures::FrozenPictures(storage::Studies& studies_, RenderService& renders_,
                               std::filesystem::path folder_)
    : studies(studies_), renders(renders_), folder(std::move(folder_)) {
  storage::make_private_folder(folder);
  storage::sweep_unfinished(folder);
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

std::string FrozenPictures::freeze(const std::string& png) {
  auto digest = sha256(png);
  if (signature_of(digest) && read_file(digest)) return digest;
  storage::write_file_durably(file_of(digest), png);
  const std::lock_guard lock(mutex);
  wrong.erase(digest);
  return digest;
}

std::optional<std::string> FrozenPictures::redraw(const std::string& digest) {
  for (const auto& render : studies.renders_of_picture(digest)) {
    try {
      const auto png = renders.artefact(render, "image.png");
      if (!png) continue;
      auto pixels = pixels_only(*png);
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
