#include "apps/command_line/manual.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/command_line/command_names.h"

namespace vibrissa::apps {
namespace {

// Troff reads a backslash as a command, and a point or a quote that begins a line.
std::string escaped(const std::string& text) {
  std::string result;
  bool begins_line = true;
  for (const char c : text) {
    if (begins_line && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\')
      result += "\\\\";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
    begins_line = c == '\n';
  }
  return result;
}

bool takes_value(const CLI::Option& option) {
  return option.get_expected_max() > 0 && option.get_type_size() != 0;
}

std::string option_heading(const CLI::Option& option) {
  std::string heading = option.get_name(false, true);
  std::replace(heading.begin(), heading.end(), ',', ' ');
  if (takes_value(option) && !option.get_positional()) heading += " " + option.get_type_name();
  return heading;
}

void add_options(const CLI::App& command, std::ostream& page) {
  for (const CLI::Option* const option : command.get_options()) {
    if (option->get_lnames() == std::vector<std::string>{"help"}) continue;
    page << ".TP\n.B " << escaped(option_heading(*option)) << "\n"
         << escaped(option->get_description());
    if (!option->get_default_str().empty())
      page << " (default: " << escaped(option->get_default_str()) << ")";
    page << "\n";
  }
}

// A footer holds examples, which are lines of their own.
void add_footer(const CLI::App& command, std::ostream& page) {
  if (command.get_footer().empty()) return;
  page << ".PP\n.nf\n" << escaped(command.get_footer()) << "\n.fi\n";
}

void add_commands(CLI::App& app, const std::string& before, std::ostream& page) {
  for (CLI::App* const command : app.get_subcommands({})) {
    const std::string name = before + command->get_name();
    page << ".SS " << escaped(name) << "\n" << escaped(command->get_description()) << "\n";
    add_options(*command, page);
    add_footer(*command, page);
    add_commands(*command, name + " ", page);
  }
}

nlohmann::json option_json(const CLI::Option& option) {
  return {{"name", option.get_name(true, true)},
          {"description", option.get_description()},
          {"value", takes_value(option) ? option.get_type_name() : ""},
          {"default", option.get_default_str()},
          {"is_required", option.get_required()}};
}

std::string words(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "" : " ").append(name);
  return text;
}

}  // namespace

std::string manual_page(CLI::App& app) {
  std::ostringstream page;
  page << ".TH VIBRISSA 1\n.SH NAME\nvibrissa \\- why a whisker or airflow sensor differs from its "
          "simulation\n.SH SYNOPSIS\n.B vibrissa\n.I command\n[options]\n.SH DESCRIPTION\n"
       << escaped(app.get_description()) << "\n";
  add_footer(app, page);
  page << ".SH COMMANDS\n";
  add_commands(app, "vibrissa ", page);
  return page.str();
}

nlohmann::json manual_json(const CLI::App& app) {
  nlohmann::json options = nlohmann::json::array(), commands = nlohmann::json::array();
  for (const CLI::Option* const option : app.get_options()) options.push_back(option_json(*option));
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(manual_json(*command));
  return {{"name", app.get_name()},
          {"description", app.get_description()},
          {"options", options},
          {"footer", app.get_footer()},
          {"commands", commands}};
}

std::string completion_script(CLI::App& app, const std::string& shell) {
  std::ostringstream script;
  if (shell == "zsh") script << "autoload -U +X bashcompinit && bashcompinit\n";
  script << "_vibrissa() {\n  local word=\"${COMP_WORDS[COMP_CWORD]}\" options=\"\"\n"
            "  case \"${COMP_WORDS[1]}\" in\n";
  for (const CLI::App* const command : app.get_subcommands({})) {
    std::vector<std::string> known = option_names(*command);
    for (const CLI::App* const inner : command->get_subcommands({})) {
      known.push_back(inner->get_name());
      for (const std::string& name : option_names(*inner)) known.push_back(name);
    }
    script << "    " << command->get_name() << ") options=\"" << words(known) << "\" ;;\n";
  }
  script << "  esac\n  if [ \"$COMP_CWORD\" -eq 1 ]; then\n    options=\""
         << words(command_names(app))
         << "\"\n  fi\n"
            "  COMPREPLY=($(compgen -W \"$options\" -- \"$word\") $(compgen -f -- \"$word\"))\n}\n"
            "complete -o filenames -F _vibrissa vibrissa\n";
  return script.str();
}

}  // namespace vibrissa::apps
