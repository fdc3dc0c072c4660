#include "server/jobs/scene_reader.h"

#include <sys/prctl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <new>

#include "renderer/error.h"
#include "scenes/library.h"
#include "scenes/picture_io.h"
#include "server/files/durable_file.h"
#include "server/jobs/child_process.h"
#include "server/jobs/memory_budget.h"

namespace penumbra::server {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

constexpr const char* picture_blob = "picture.png";

// Grey of L* 50, on which participants see pictures (web/shared/base.css).
constexpr std::uint8_t surround = 118;

/// Writes what `read` returns, or why it failed, as a message.
template <class Read>
int run_reader(std::uint64_t memory_limit, const Read& read) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // never outlives who waits for it
  Message message;
  try {
    limit_memory(memory_limit);
    message = read();
  } catch (const Error& error) {
    message.body["error"] = {
        {"code", error.code}, {"message", error.what()}, {"field", error.field}};
  } catch (const std::bad_alloc&) {
    message.body["error"] = {{"code", "unsupported"},
                             {"message", "this file needs more memory than reading it may take"},
                             {"field", "body"}};
  }
  write_message(STDOUT_FILENO, message);
  return 0;
}

}  // namespace

SceneReader::SceneReader(SceneReaderOptions options) : options_(std::move(options)) {
  if (options_.command.empty()) options_.command = {"/proc/self/exe", "worker"};
  if (options_.memory_limit == 0) options_.memory_limit = worker_memory(most_at_once);
}

json SceneReader::read(const std::filesystem::path& file, const std::function<bool()>& stopping) {
  return read_with("--read-scene", file, stopping).body.at("scene");
}

UploadedPicture SceneReader::read_picture(const std::filesystem::path& file,
                                          const std::function<bool()>& stopping) {
  auto message = read_with("--read-picture", file, stopping);
  const auto& about = message.body.at("picture");
  return {std::move(message.blobs.at(picture_blob)), about.at("width").get<std::uint32_t>(),
          about.at("height").get<std::uint32_t>()};
}

Message SceneReader::read_with(const char* option, const std::filesystem::path& file,
                               const std::function<bool()>& stopping) {
  const auto deadline =
      steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(
                                std::chrono::duration<double>(options_.deadline_s));
  if (!places_.try_acquire_until(deadline)) throw Error("busy", "other uploads are being read");
  struct Place {
    decltype(places_)& places;
    ~Place() { places.release(); }
  } const place{places_};

  ++read_;
  std::vector<std::string> arguments = options_.command;
  arguments.insert(arguments.end(), {"--memory-limit", std::to_string(options_.memory_limit),
                                     option, file.string()});
  ChildProcess child(std::move(arguments), {});
  Message message;
  switch (MessageReader(child.output()).read(message, deadline, stopping)) {
    case Exchange::message:
      break;
    case Exchange::stopped:
      throw Error("draining", "the server is stopping");
    case Exchange::deadline:
      ++deadlines_;
      throw Error("deadline", "the file was not read in time");
    default: {
      ++died_;
      const auto how = child.ended(0.5);
      throw unreadable("the reader " + how.value_or("failed") + " at this file", "body");
    }
  }
  if (const auto error = message.body.find("error"); error != message.body.end()) {
    ++refused_;
    throw Error(error->value("code", "internal"), error->value("message", ""),
                error->value("field", ""));
  }
  return message;
}

json SceneReader::statistics() const {
  return {{"read", read_.load()},
          {"refused", refused_.load()},
          {"died", died_.load()},
          {"deadlines", deadlines_.load()}};
}

int run_scene_reader(const std::filesystem::path& file, std::uint64_t memory_limit) {
  return run_reader(memory_limit, [&]() -> Message {
    const auto scene = scenes::load(file.string());
    return {{{"scene", {{"title", scene->title}, {"notes", scene->notes}}}}, {}};
  });
}

int run_picture_reader(const std::filesystem::path& file, std::uint64_t memory_limit) {
  return run_reader(memory_limit, [&]() -> Message {
    const auto bytes = read_whole(file);
    if (!bytes) throw unreadable("the file cannot be read", "body");
    const auto picture = scenes::decode_shown(*bytes, 4 * most_uploaded_pixels, surround);
    return {{{"picture", {{"width", picture.width}, {"height", picture.height}}}},
            {{picture_blob, scenes::encode_png(picture)}}};
  });
}

}  // namespace penumbra::server
