// Files installed by `cmake --install` work in their installed location.

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_install_test {

namespace {

using fathom::test::Folder;
using fathom::test::png_size;
using fathom::test::Result;

}  // namespace

TEST_CASE("cli: cmake --install installs a program that renders an installed scene from another folder", "[cli]") {
  const Folder folder;
  const Result result = folder.run_script(R"sh(
    unset DESTDIR
    cmake --install "$(dirname "$fathom")" --prefix "$PWD/prefix" --component program >log || exit 3
    mkdir elsewhere && cd elsewhere
    "$OLDPWD/prefix/bin/fathom" render ../prefix/share/fathom/scenes/primitives.json --size 16x9 -s 1 -q -o ../out.png
  )sh");
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(png_size(folder.read("out.png")) == std::pair(16, 9));
  const std::string share = "prefix/share/";
  CHECK(folder.read(share + "bash-completion/completions/fathom") == folder.run("completion bash").out);
  CHECK(folder.read(share + "zsh/site-functions/_fathom") == folder.run("completion zsh").out);
  CHECK(folder.read(share + "fish/vendor_completions.d/fathom.fish") == folder.run("completion fish").out);
  CHECK(folder.read(share + "man/man1/fathom.1") == folder.run("man").out);
  for (const char* file : {"README.md", "LICENSE", "docs/reference/scene-file.md"}) {
    CHECK(folder.has(share + "doc/fathom/" + file));
  }
}

}  // namespace fathom::cli_install_test
