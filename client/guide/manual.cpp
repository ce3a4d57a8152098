// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "guide/guide.hpp"

namespace anticrack::guide {
namespace {

/// The text escaped so that roff prints it unchanged, including "-".
std::string plain(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool starts_line = i == 0 || text[i - 1] == '\n';
    if (starts_line && (text[i] == '.' || text[i] == '\'')) result += "\\&";
    result += text[i] == '\\' ? "\\e" : text[i] == '-' ? "\\-" : std::string(1, text[i]);
  }
  return result;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

class PageWriter {
 public:
  PageWriter(const Command& program, const Command& command, int section,
             const std::string& version)
      : _program(program), _command(command), _section(section) {
    _out << ".TH " << upper(page_of(command)) << ' ' << section << " \"\" \"" << version << "\"\n";
    _out << ".SH NAME\n"
         << plain(page_of(command)) << " \\- " << plain(command.description) << '\n';
    synopsis();
    listed("COMMANDS", [this] {
      for (const Command& below : _command.commands)
        item("\\fB" + plain(below.name) + "\\fR",
             fmt::format("{}: see {}({})", below.description, page_of(below), _section));
    });
    listed("ARGUMENTS", [this] {
      for (const Option& argument : _command.positionals) {
        item("\\fI" + plain(argument.names.front()) + "\\fR", argument.description);
      }
    });
    listed("OPTIONS", [this] {
      for (const Option& option : _command.options) add(option);
    });
    footer();
    if (&program != &command) {
      _out << ".SH SEE ALSO\n.BR " << plain(program.name) << " (" << section
           << "):\noptions of every command, exit codes\n";
    }
  }

  Page page() const { return {fmt::format("{}.{}", page_of(_command), _section), _out.str()}; }

 private:
  std::string page_of(const Command& command) const {
    std::string path = command.path;
    std::replace(path.begin(), path.end(), ' ', '-');
    return path.empty() ? _program.name : _program.name + "-" + path;
  }

  void synopsis() {
    _out << ".SH SYNOPSIS\n.B " << plain(_program.name);
    if (!_command.path.empty()) _out << ' ' << plain(_command.path);
    _out << "\n[\\fIOPTIONS\\fR]";
    for (const Option& argument : _command.positionals)
      _out << " \\fI" << plain(argument.names.front()) << "\\fR";
    if (!_command.commands.empty()) _out << " \\fICOMMAND\\fR";
    _out << '\n';
  }

  /// Writes a section, unless `write` adds no item.
  template <class Write>
  void listed(const std::string& title, const Write& write) {
    _title = title;
    write();
  }

  void item(const std::string& head, const std::string& text) {
    if (!_title.empty()) _out << ".SH " << _title << '\n';
    _title.clear();
    _out << ".TP\n" << head << '\n' << plain(text) << '\n';
  }

  void add(const Option& option) {
    std::string head;
    for (const std::string& name : option.names)
      head += (head.empty() ? "" : ", ") + ("\\fB" + plain(name) + "\\fR");
    item(option.type.empty() ? head : head + " \\fI" + plain(option.type) + "\\fR",
         option.description);
  }

  /// Writes paragraphs; one whose first line ends with a colon becomes a section of that name.
  void footer() {
    std::istringstream lines(_command.footer);
    bool begins = true;
    bool verbatim = false;
    for (std::string line; std::getline(lines, line);) {
      if (line.empty()) {
        begins = true;
        continue;
      }
      if (begins && line.back() == ':') {
        if (verbatim) _out << ".fi\n";
        _out << ".SH " << upper(line.substr(0, line.size() - 1)) << "\n.nf\n";
        verbatim = true;
      } else {
        if (begins && !verbatim) _out << (_described ? ".PP\n" : ".SH DESCRIPTION\n");
        _described = _described || !verbatim;
        _out << plain(line) << '\n';
      }
      begins = false;
    }
    if (verbatim) _out << ".fi\n";
  }

  const Command& _program;
  const Command& _command;
  int _section;
  std::string _title;  // title of a section that is still empty
  bool _described = false;
  std::ostringstream _out;
};

}  // namespace

std::vector<Page> manual(const CLI::App& app, int section, const std::string& version) {
  const Command program = command_tree(app);
  std::vector<Page> pages;
  for (const Command* command : with_all_below(program))
    pages.push_back(PageWriter(program, *command, section, version).page());
  return pages;
}

}  // namespace anticrack::guide
