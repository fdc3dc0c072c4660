#include "server/cli/command_line.h"

int main(int argc, char** argv) {
  return penumbra::server::cli::run(argc, argv);
}
