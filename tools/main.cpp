#include <gonio/mapping/base/error.h>
#include <gonio/tools/convert.h>
#include <gonio/tools/fit.h>
#include <gonio/tools/info.h>
#include <gonio/tools/light/light.h>
#include <gonio/tools/ndf.h>
#include <gonio/tools/render/compare.h>
#include <gonio/tools/render/render.h>
#include <gonio/tools/report/report.h>
#include <gonio/tools/stability/stability.h>
#include <gonio/tools/synth.h>
#include <gonio/tools/validate.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>

namespace {

/// Prints one line on stderr, whatever the message holds.
int fail(const CLI::App& app, std::string message) {
  std::string program = "gonio";
  for (const CLI::App* verb : app.get_subcommands()) program += " " + verb->get_name();
  std::fflush(stdout);
  for (char& c : message) c = std::iscntrl(static_cast<unsigned char>(c)) ? ' ' : c;
  std::fprintf(stderr, "%s: %s\n", program.c_str(), message.c_str());
  return 1;
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  if (!app.get_subcommands().empty()) return std::string(error.what()) + "; see --help";
  std::string verbs;
  for (const CLI::App* verb : app.get_subcommands({})) {
    verbs += (verbs.empty() ? "" : ", ") + verb->get_name();
  }
  const bool unknown = !app.remaining().empty();
  return (unknown ? "found '" + app.remaining().front() + "'" : std::string("found no verb")) +
         ", expected one of " + verbs + "; see --help";
}

/// What could not be written is an error even where no one looks at each write, as in --help.
void flush_output() {
  std::cout.flush();
  if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw gonio::Error("standard output: cannot be written");
}

/// Runs the verb, or prints help or the version.
void run(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw;
    app.exit(error);  // --help, --version
  }
  flush_output();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Importance sampling of measured isotropic BRDFs.", "gonio");
  app.set_version_flag("--version", "gonio " GONIO_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Angles are in degrees. Each verb has examples: gonio VERB --help.\n"
      "Exit status: 0, or 1 after an error, which is one line on stderr.");
  gonio::add_info(app);
  gonio::add_validate(app);
  gonio::add_convert(app);
  gonio::add_report(app, {argv + 1, argv + argc});
  gonio::add_synth(app);
  gonio::add_fit(app);
  gonio::add_light(app);
  gonio::add_stability(app);
  gonio::add_ndf(app);
  gonio::add_render(app);
  gonio::add_compare(app);
  try {
    run(app, argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    return fail(app, usage_error(app, error));
  } catch (const std::bad_alloc&) {
    return fail(app, "not enough memory");
  } catch (const std::exception& error) {
    return fail(app, error.what());
  }
}
