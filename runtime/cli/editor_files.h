// Editor support for Fathom's own notation, generated from the language's vocabulary: syntax highlighting and more.
// Tested by: tests/runtime/cli/cli_editor_test.cpp
#pragma once

#include <string>
#include <vector>

namespace fathom::cli {

struct EditorFile {
  std::string path;  // relative to the extension's folder
  std::string text;
};

// Returns a syntax file for Vim and Neovim.
std::string vim_syntax();

// Returns an extension for Visual Studio Code: colours, brackets, comments, and a problem matcher for the output of
// `fathom check --error-format short`.
std::vector<EditorFile> vscode_extension();

}  // namespace fathom::cli
