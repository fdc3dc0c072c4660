#pragma once

// The public set-up as deploy/nginx.conf describes it: the real nginx in front of the server.
#include <arpa/inet.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <thread>

#include "tests/http/running_server.h"

namespace penumbra::server::http {

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class BehindNginx : public RunningServer {
 protected:
  void SetUp() override {
    options.public_url = "https://study.example.org";
    RunningServer::SetUp();
    make_certificate();
    port = free_port();
    write_configuration();
    process = ::fork();
    if (process == 0) {
      const auto configuration = (place / "nginx.conf").string();
      ::execl("/usr/sbin/nginx", "nginx", "-c", configuration.c_str(), "-p", place.c_str(),
              static_cast<char*>(nullptr));
      ::_exit(127);
    }
    outside = std::make_unique<httplib::SSLClient>("127.0.0.1", port);
    outside->enable_server_certificate_verification(false);
    outside->set_default_headers({{"Host", "study.example.org"}});
    as_researcher = {{"Authorization", "Bearer " + server->token()}};
    outside->set_connection_timeout(2);
    outside->set_read_timeout(10);
    bool up = false;
    for (int i = 0; i < 100 && !up; ++i) {
      up = static_cast<bool>(outside->Get("/"));
      if (!up) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    ASSERT_TRUE(up) << text_of(place / "start.log");
  }

  void TearDown() override {
    outside.reset();
    ::kill(process, SIGQUIT);
    ::waitpid(process, nullptr, 0);
  }

  void make_certificate() const {
    std::filesystem::create_directories(place);
    const auto command = "openssl req -x509 -newkey rsa:2048 -nodes -subj /CN=x -days 2 -keyout " +
                         (place / "privkey.pem").string() + " -out " +
                         (place / "fullchain.pem").string() + " 2>/dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
  }

  /// A port that was free a moment ago.
  static int free_port() {
    const int descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ::bind(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address);
    ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size);
    ::close(descriptor);
    return ntohs(address.sin_port);
  }

  /// What a test changes in the file.
  virtual void edit(std::string&) const {}

  /// The file as it is, with this machine's ports and paths.
  void write_configuration() const {
    auto site = text_of(std::string(PENUMBRA_SOURCE_DIR) + "/deploy/nginx.conf");
    const auto replace = [&](const std::string& what, const std::string& by) {
      const auto changed = std::regex_replace(site, std::regex(what), by);
      ASSERT_NE(changed, site) << what;
      site = changed;
    };
    replace("/etc/letsencrypt/live/study\\.example\\.org", place.string());
    replace("/var/log/nginx", place.string());
    replace("127\\.0\\.0\\.1:8080", "127.0.0.1:" + std::to_string(server->port()));
    replace("listen \\[::\\]:[^;]*;", "");
    replace("listen 443 ", "listen 127.0.0.1:" + std::to_string(port) + " ");
    replace("listen 80;", "listen unix:" + (place / "plain.socket").string() + ";");
    edit(site);
    std::ofstream(place / "site.conf") << site;
    std::ofstream(place / "nginx.conf")
        << (::geteuid() == 0 ? "user root;\n" : "") << "daemon off;\npid " << place.string()
        << "/pid;\nerror_log " << place.string() << "/start.log;\nevents {}\nhttp {\n"
        << "client_body_temp_path body;\nproxy_temp_path proxy;\nfastcgi_temp_path fastcgi;\n"
        << "uwsgi_temp_path uwsgi;\nscgi_temp_path scgi;\ninclude site.conf;\n}\n";
  }

  std::filesystem::path place = folder.path / "nginx";
  int port = 0;
  pid_t process = -1;
  std::unique_ptr<httplib::SSLClient> outside;
  httplib::Headers as_researcher;
};

}  // namespace penumbra::server::http
