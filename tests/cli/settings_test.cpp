#include <gmock/gmock.h>
#include <stdlib.h>

#include <fstream>

#include "renderer/error.h"
#include "server/cli/session.h"
#include "tests/jobs/temporary_folder.h"

namespace penumbra::server::cli {
namespace {

using testing::ElementsAre;
using Arguments = std::vector<std::string>;

class SettingsTest : public testing::Test {
 protected:
  SettingsTest() {
    CLI::App* serve = app.add_subcommand("serve", "");
    serve->add_option("--port", port);
    serve->add_option("--ops-port", ops_port);
    CLI::App* demo = app.add_subcommand("demo", "");
    demo->add_option("--data", data);
  }
  ~SettingsTest() override {
    for (const char* name :
         {"PENUMBRA_PORT", "PENUMBRA_OPS_PORT", "PENUMBRA_PROT", "PENUMBRA_CONFIG"})
      ::unsetenv(name);
  }

  std::string config(const std::string& text) {
    const std::string path = (folder.path() / "config.toml").string();
    std::ofstream(path) << text;
    return path;
  }
  std::string refused_field(const Arguments& arguments) {
    try {
      complete_arguments(app, arguments);
    } catch (const Error& error) {
      return error.field;
    }
    return "accepted";
  }

  TemporaryFolder folder;
  CLI::App app;
  int port = 0;
  int ops_port = 0;
  std::string data;
};

TEST_F(SettingsTest, leave_the_arguments_alone_where_nothing_else_is_said) {
  EXPECT_THAT(complete_arguments(app, {"serve", "--port", "1"}),
              ElementsAre("serve", "--port", "1"));
}

TEST_F(SettingsTest, prefer_the_flag_to_the_environment_to_the_file) {
  const std::string path = config("[serve]\nport = 3\nops-port = 3\n");
  ::setenv("PENUMBRA_PORT", "2", 1);
  EXPECT_THAT(complete_arguments(app, {"--config", path, "serve"}),
              ElementsAre("serve", "--port=2", "--ops-port=3"));
  EXPECT_THAT(complete_arguments(app, {"serve", "--config=" + path, "--port=1"}),
              ElementsAre("serve", "--ops-port=3", "--port=1"));
}

TEST_F(SettingsTest, take_keys_outside_sections_for_every_command_that_has_them) {
  ::setenv("PENUMBRA_CONFIG", config("port = 3\ndata = \"here\"\n").c_str(), 1);
  EXPECT_THAT(complete_arguments(app, {"serve"}), ElementsAre("serve", "--port=3"));
  EXPECT_THAT(complete_arguments(app, {"demo"}), ElementsAre("demo", "--data=here"));
}

TEST_F(SettingsTest, refuse_unknown_keys_by_name) {
  EXPECT_EQ(refused_field({"--config", config("prot = 3\n"), "serve"}), "prot");
  EXPECT_EQ(refused_field({"--config", config("[serve]\nprot = 3\n"), "serve"}), "serve.prot");
  EXPECT_EQ(refused_field({"--config", config("[server]\nport = 3\n"), "serve"}), "server");
  ::setenv("PENUMBRA_PROT", "3", 1);
  EXPECT_EQ(refused_field({"serve"}), "PENUMBRA_PROT");
}

TEST_F(SettingsTest, refuse_a_file_that_is_not_there) {
  EXPECT_EQ(refused_field({"--config", "/no/such/file", "serve"}), "config");
  EXPECT_EQ(refused_field({"serve", "--config"}), "config");
}

}  // namespace
}  // namespace penumbra::server::cli
