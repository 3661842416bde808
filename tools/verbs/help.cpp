#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>

#include "tools/verbs/verbs.h"

namespace gonio {
namespace {

void help(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* verb = &app;
  std::string name = app.get_name();
  for (const std::string& word : words) {
    const auto next = verb->get_subcommands([&](const CLI::App* own) { return own->get_name() == word; });
    if (next.empty()) {
      const std::vector<std::string> known = verb_names(*verb);
      throw Error("found '" + word + "', expected " + (known.empty() ? "no verb of " + name : one_of(known, word)));
    }
    verb = next.front();
    name += " " + word;
  }
  // Not App::help(), which says what `help` itself takes.
  std::fputs(app.get_formatter()->make_help(verb, name, CLI::AppFormatMode::Normal).c_str(), stdout);
}

}  // namespace

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands({})) names.push_back(verb->get_name());
  return names;
}

void add_help(CLI::App& app) {
  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* verb = app.add_subcommand("help", "What --help says, of a verb as well");
  verb->add_option("VERB", *words, "A verb, and one of its own verbs if it has some");
  verb->footer(
      "Examples:\n"
      "  gonio help\n"
      "  gonio help convert\n"
      "  gonio help light plot");
  verb->callback([words, &app] { help(app, *words); });
}

}  // namespace gonio
