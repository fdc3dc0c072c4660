// What is done with a data folder as a whole: backup, restore, verify, repair, export.
#include <httplib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "renderer/error.h"
#include "server/cli/session.h"
#include "server/http/frozen_pictures.h"
#include "server/http/serve.h"
#include "server/jobs/render_service.h"
#include "server/storage/backup.h"
#include "server/storage/data_folder.h"
#include "server/storage/folder_files.h"
#include "server/storage/repair.h"
#include "server/storage/studies.h"

namespace penumbra::server::cli {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for a copy, gone at the end.
struct PassingFolder {
  PassingFolder() {
    std::string name = (fs::temp_directory_path() / "penumbra-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw Error("storage", "no folder for a copy");
    path = name;
  }
  ~PassingFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  fs::path path;
};

int back_up(const Session& session, const fs::path& data, const fs::path& out) {
  storage::back_up(data, out);
  const auto bytes = fs::file_size(out);
  session.print({{"file", out.string()}, {"bytes", bytes}},
                out.string() + ": " + std::to_string(bytes) + " bytes\n");
  return 0;
}

int restore(const Session& session, const fs::path& backup, const fs::path& data) {
  storage::restore(backup, data);
  session.print({{"data", data.string()}}, data.string() + " is restored\n");
  return 0;
}

/// A data folder, or a backup, which is unpacked for it.
int verify(const Session& session, const fs::path& data) {
  std::vector<std::string> wrong;
  if (fs::is_regular_file(data)) {
    const PassingFolder passing;
    try {
      storage::restore(data, passing.path / "data");
      wrong = storage::verify_folder(passing.path / "data");
    } catch (const Error& error) {
      wrong = {error.what()};
    }
  } else {
    wrong = storage::verify_folder(data);
  }
  std::string text;
  for (const auto& line : wrong) text += line + "\n";
  session.print({{"sound", wrong.empty()}, {"damage", wrong}},
                wrong.empty() ? data.string() + " is sound\n" : text);
  return wrong.empty() ? 0 : 1;
}

/// Pictures of studies whose file is gone or altered: drawn again from their renders, where those
/// are known and give the same pixels. verify names the others.
void redraw(const fs::path& data, const std::vector<std::string>& digests) {
  const storage::DataFolder lock(data);
  storage::Database database(data / storage::database_name);
  storage::Studies studies(database);
  RenderServiceOptions options;
  options.data = data;
  const auto renders = make_render_service(options);
  http::FrozenPictures pictures(studies, *renders, data);
  for (const auto& digest : digests) {
    try {
      pictures.read(digest);
    } catch (const Error& error) {
      std::cerr << digest << ": " << error.what() << '\n';
    }
  }
}

int repair(const Session& session, const fs::path& data) {
  http::log_to_standard_error();
  const auto repair = storage::repair_folder(data);
  if (!repair.pictures.empty()) redraw(data, repair.pictures);
  const auto wrong = repair.found.empty() ? repair.found : storage::verify_folder(data);
  std::string text;
  for (const auto& line : repair.aside) text += line + "\n";
  if (repair.found.empty())
    text = data.string() + " is sound: nothing was done\n";
  else
    text += std::to_string(repair.kept) + " rows kept, " + std::to_string(repair.aside.size()) +
            " told of; as it was: " + repair.folder.string() + "\n";
  for (const auto& line : wrong) text += "still wrong: " + line + "\n";
  session.print({{"sound", wrong.empty()},
                 {"found", repair.found},
                 {"rows_kept", repair.kept},
                 {"rows", repair.aside},
                 {"folder", repair.folder.string()},
                 {"damage", wrong}},
                text);
  return wrong.empty() ? 0 : 1;
}

/// The archive that the server gives to researchers, of a copy: the server that owns the folder
/// goes on meanwhile.
int export_study(const Session& session, const std::string& study, const fs::path& data,
                 const fs::path& out) {
  http::log_to_standard_error();
  const PassingFolder passing;
  for (const auto& line : storage::copy_folder(data, passing.path / "data"))
    std::cerr << "damaged: " << line << '\n';
  http::ServeOptions options;
  options.port = 0;
  options.ops_port = -1;
  options.data = passing.path / "data";
  RenderServiceOptions renders;
  renders.data = options.data;
  http::Server server(options, [&] { return make_render_service(renders); });
  server.start();
  httplib::Client client("127.0.0.1", server.port());
  client.set_bearer_token_auth(server.token());
  client.set_read_timeout(600);
  const auto reply = client.Get("/api/v1/studies/" + study + "/export.zip");
  if (!reply) throw Error("internal", "the export failed");
  if (reply->status != 200) {
    const auto body = nlohmann::json::parse(reply->body, nullptr, false);
    const auto error =
        body.is_object() ? body.value("error", nlohmann::json::object()) : nlohmann::json::object();
    throw Error(error.value("code", "internal"),
                "study " + study + ": " + error.value("message", "the export failed"));
  }
  storage::write_file_durably(fs::absolute(out), reply->body);
  session.print({{"file", out.string()}, {"bytes", reply->body.size()}},
                out.string() + ": " + std::to_string(reply->body.size()) + " bytes\n");
  return 0;
}

}  // namespace

void add_data_commands(CLI::App& app, Session& session) {
  struct Options {
    fs::path data = "data";
    fs::path out;
    fs::path from;
    std::string study;
  };
  const auto add = [&](const char* name, const char* what,
                       const std::function<int(const Options&)>& action, auto more) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(name, what);
    command->add_option("--data", options->data, "Folder of everything the server keeps")
        ->capture_default_str();
    more(*command, *options);
    add_json_flag(*command, session);
    command->callback([options, action, &session] {
      session.action = [options, action] {
        ::umask(0077);  // all of it holds tokens
        return action(*options);
      };
    });
  };
  const auto out = [](CLI::App& command, Options& options) {
    command.add_option("--out", options.out, "File to write")->required();
  };
  add(
      "backup", "Write a data folder into one file; a server may be running on it",
      [&session](const Options& o) { return back_up(session, o.data, o.out); }, out);
  add(
      "restore", "Unpack a backup into a new data folder",
      [&session](const Options& o) { return restore(session, o.from, o.data); },
      [](CLI::App& command, Options& options) {
        command.add_option("BACKUP", options.from, "File that backup wrote")
            ->required()
            ->check(CLI::ExistingFile);
      });
  add(
      "verify", "Say whether a data folder or a backup (--data FILE) is sound",
      [&session](const Options& o) { return verify(session, o.data); }, [](CLI::App&, Options&) {});
  add(
      "repair", "Make a damaged data folder sound; nothing is deleted",
      [&session](const Options& o) { return repair(session, o.data); }, [](CLI::App&, Options&) {});
  add(
      "export", "Write the archive of a study's answers",
      [&session](const Options& o) { return export_study(session, o.study, o.data, o.out); },
      [&out](CLI::App& command, Options& options) {
        command.add_option("STUDY", options.study, "Its id")->required();
        out(command, options);
      });
}

}  // namespace penumbra::server::cli
