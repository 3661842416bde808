#include <cctype>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>

#include "tools/verbs/verbs.h"

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

/// The first argument that looks like an option and is none; empty if there is no such.
std::string unknown_option(const CLI::App& verb) {
  for (const std::string& argument : verb.remaining())
    if (argument.size() > 1 && argument.front() == '-') return argument.substr(0, argument.find('='));
  return {};
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* verb = &app;  // the first that left a word over, or the last
  while (!verb->get_subcommands().empty() && verb->remaining().empty()) verb = verb->get_subcommands().front();
  std::string found = unknown_option(*verb);
  std::vector<std::string> known;
  if (!found.empty()) {
    for (const CLI::Option* option : verb->get_options())
      if (option->nonpositional()) known.push_back(option->get_name());
  } else if (known = gonio::verb_names(*verb); !known.empty()) {
    if (!verb->remaining().empty()) found = verb->remaining().front();
  } else {
    return std::string(error.what()) + "; see --help";
  }
  return (found.empty() ? "found no verb" : "found '" + found + "'") + ", expected " + gonio::one_of(known, found) +
         "; see --help";
}

/// What could not be written is an error even where no one looks at each write, as in --help.
void flush_output() {
  std::cout.flush();
  if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw gonio::Error("standard output: cannot be written");
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
  gonio::add_help(app);
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
