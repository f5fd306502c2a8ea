// What editors read to colour texts in Fathom's own notation, made from the language's tables of words.
// Tested by: tests/runtime/cli/cli_editor_test.cpp
#pragma once

#include <string>
#include <vector>

namespace fathom::cli {

struct EditorFile {
  std::string path;  // below the extension's folder
  std::string text;
};

// A syntax file of Vim and Neovim.
std::string vim_syntax();

// An extension of Visual Studio Code: colours, brackets, comments, and a problem matcher for what
// `fathom check --error-format short` prints.
std::vector<EditorFile> vscode_extension();

}  // namespace fathom::cli
