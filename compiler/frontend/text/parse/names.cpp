#include "compiler/frontend/text/parse/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>

#include "compiler/frontend/formula/formula.h"
#include "compiler/frontend/formula/formula_parser.h"
#include "compiler/frontend/syntax/suggest.h"
#include "compiler/frontend/text/parse/order.h"
#include "compiler/frontend/text/parse/vocabulary.h"

namespace fathom::compiler::text {
namespace {

using Kind = Statement::Kind;

// Maximum number of errors with a suggestion, which is also the number of errors printed. Finding the nearest name is
// slow in a file with many names.
constexpr std::size_t kMaxSuggestions = 20;

bool has_name(const Statement& statement) {
  return statement.kind == Kind::Import || statement.kind == Kind::Param || statement.kind == Kind::Let ||
         statement.kind == Kind::Def;
}

// True for `of.name` or `of.name(...)`, as opposed to `name(of)`.
bool is_dotted(const Expr& expr) { return expr.span.begin < expr.name_span.begin; }

class Resolver {
 public:
  Resolver(Tree& tree, Diagnostics& diagnostics) : tree_(tree), diagnostics_(diagnostics) {}

  std::optional<std::vector<std::uint32_t>> run() {
    uses_.resize(tree_.statements.size());
    globals_.resize(tree_.modules.size());
    imported_.resize(tree_.statements.size());
    for (current_ = 0; current_ < tree_.statements.size(); ++current_) declare_global(current_);
    for (current_ = 0; current_ < tree_.statements.size(); ++current_) resolve_statement(tree_.statements[current_]);
    warn_of_unused_imports();
    return in_order(tree_, uses_, diagnostics_);
  }

 private:
  struct Local {
    std::string_view name;
    Span span;
    std::uint32_t slot;
    bool used;
  };

  void declare_global(std::uint32_t number) {
    const Statement& statement = tree_.statements[number];
    if (!has_name(statement)) return;
    check_name(statement.name, statement.name_span);
    const auto [found, is_new] = globals_[statement.module].emplace(statement.name, number);
    if (!is_new) report_twice(statement.name, statement.name_span);
    if (statement.kind == Kind::Def && find_word(statement.name)) {
      warning("W0406", statement.name_span, fmt::format("`{}` is a function already", statement.name), "",
              {"this one takes its place in the file: choose another name"});
    }
  }

  // True for a file's second and later modules. Errors in a file are reported for its first module only.
  bool is_quiet() const { return tree_.modules[tree_.statements[current_].module].again; }
  void error(std::string code, Span span, std::string message, std::string label, std::vector<std::string> help) {
    if (is_quiet()) return;
    diagnostics_.error(std::move(code), span, std::move(message), std::move(label), std::move(help));
  }
  void warning(std::string code, Span span, std::string message, std::string label, std::vector<std::string> help) {
    if (is_quiet()) return;
    diagnostics_.warning(std::move(code), span, std::move(message), std::move(label), std::move(help));
  }

  const std::unordered_map<std::string_view, std::uint32_t>& globals() const {
    return globals_[tree_.statements[current_].module];
  }
  std::span<const Statement> statements_of(const Module& module) const {
    return std::span<const Statement>(tree_.statements).subspan(module.begin, module.end - module.begin);
  }
  bool has_values(const Statement& statement) const {
    return statement.kind == Kind::Param && tree_.modules[statement.module].has_values;
  }

  void check_name(std::string_view name, Span span) {
    if (name != "x" && name != "y" && name != "z" && !formula_constant(name)) return;
    error(
        "E0407", span,
        fmt::format("the name `{}` is {}", name, formula_constant(name) ? "a constant of formulas" : "a coordinate"),
        "", {fmt::format("choose another name, such as {0}0 or {0}_", name)});
  }

  void report_twice(std::string_view name, Span span) {
    error("E0802", span, fmt::format("`{}` is declared twice", name), "",
          {"a name has one value: choose another for the second"});
  }

  void resolve_statement(Statement& statement) {
    slots_ = 0;
    locals_.clear();
    if (statement.kind == Kind::Def) {
      for (Argument& parameter : statement.fields) {
        if (parameter.value) resolve(*parameter.value);
        declare(parameter.name, parameter.name_span, 0);
      }
    } else {
      for (const Argument& field : statement.fields) resolve(*field.value);
    }
    if (statement.kind == Kind::Import) check_values(statement);
    if (has_values(statement))
      uses_[current_].push_back({tree_.modules[statement.module].values, statement.name_span});
    if (statement.value) resolve(*statement.value);
    leave(0, true);
    statement.slots = slots_;
  }

  // Declares a local name, which must not have been declared since `from`.
  std::uint32_t declare(std::string_view name, Span span, std::size_t from) {
    check_name(name, span);
    for (std::size_t i = from; i < locals_.size(); ++i) {
      if (locals_[i].name == name) report_twice(name, span);
    }
    const auto slot = static_cast<std::uint32_t>(locals_.size());
    locals_.push_back({name, span, slot, false});
    slots_ = std::max(slots_, slot + 1);
    return slot;
  }

  // Ends the scope of the names declared since `from`. If `warn`, reports the unused names.
  void leave(std::size_t from, bool warn) {
    for (std::size_t i = from; i < locals_.size() && warn; ++i) {
      if (locals_[i].used || locals_[i].name[0] == '_') continue;
      warning("W0405", locals_[i].span, fmt::format("unused name `{}`", locals_[i].name), "",
              {"remove it, or begin it with _ to keep it"});
    }
    locals_.resize(from);
  }

  void resolve(Expr& expr) {
    using enum Expr::Kind;
    const std::size_t from = locals_.size();
    if (enter_module(expr)) return;
    switch (expr.kind) {
      case Name:
        return resolve_name(expr);
      case Let:
        for (Argument& binding : expr.arguments) {
          resolve(*binding.value);
          const std::uint32_t slot = declare(binding.name, binding.name_span, from);
          if (&binding == &expr.arguments.front()) expr.reference = {Reference::Kind::Local, slot};
        }
        resolve(*expr.of[0]);
        return leave(from, true);
      case For:
        resolve(*expr.of[0]);
        expr.reference = {Reference::Kind::Local, declare(expr.name, expr.name_span, from)};
        resolve(*expr.of[1]);
        return leave(from, false);
      case Fold:
        resolve(*expr.of[0]), resolve(*expr.of[1]);
        expr.reference = {Reference::Kind::Local, declare(expr.name, expr.name_span, from)};
        declare(expr.arguments[0].name, expr.arguments[0].name_span, from);
        resolve(*expr.of[2]);
        return leave(from, false);
      case Call:
        if (expr.reference.kind == Reference::Kind::None) resolve_function(expr);
        break;
      default:
        break;
    }
    for (Expr* part : expr.of) resolve(*part);
    for (const Argument& argument : expr.arguments) resolve(*argument.value);
    for (const Joint& joint : expr.joints) {
      if (joint.blend) resolve(*joint.blend);
    }
  }

  // Returns the import that a name refers to, or nullopt if the name refers to something else.
  std::optional<std::uint32_t> import_of(const Expr& expr) const {
    if (expr.kind != Expr::Kind::Name || expr.groups > 0) return std::nullopt;
    if (std::ranges::any_of(locals_, [&](const Local& local) { return local.name == expr.name; }))
      return std::nullopt;
    const auto found = globals().find(expr.name);
    if (found == globals().end() || tree_.statements[found->second].kind != Kind::Import) return std::nullopt;
    return found->second;
  }

  // Resolves `gears.steel`, `gears.gear(...)` and `gears.scene` where `gears` is an import. Returns true if nothing
  // is left to resolve.
  bool enter_module(Expr& expr) {
    const bool call = expr.kind == Expr::Kind::Call && is_dotted(expr);
    if (!call && expr.kind != Expr::Kind::Member) return false;
    const std::optional<std::uint32_t> import = import_of(call ? *expr.arguments[0].value : *expr.of[0]);
    if (!import) return false;
    refer_into(expr, *import, call);
    if (!call) return true;
    for (const Argument& argument : expr.arguments) resolve(*argument.value);
    return true;
  }

  // Not inlined, like the functions it calls: resolve() recurses a thousand levels deep, and messages would enlarge
  // its stack frame.
  [[gnu::noinline]] void refer_into(Expr& expr, std::uint32_t import, bool call) {
    imported_[import] = true;
    const Statement& statement = tree_.statements[import];
    if (tree_.statements[current_].kind == Kind::Param) {
      error("E0402", expr.name_span, fmt::format("`{}.{}` has no value yet", statement.name, expr.name), "",
            {"parameters have their values before anything else"});
    }
    uses_[current_].push_back({import, expr.name_span});
    if (call) {
      expr.arguments.erase(expr.arguments.begin());
    } else {
      expr.kind = Expr::Kind::Name;
      expr.of.clear();
    }
    refer_to(expr, statement, call);
  }

  // Resolves a name in the module that the import refers to.
  void refer_to(Expr& expr, const Statement& import, bool call) {
    const Module& module = tree_.modules[import.target];
    const auto found = globals_[import.target].find(expr.name);
    const bool known = found != globals_[import.target].end();
    if (!known && !call && expr.name == "scene") return refer_to_objects(expr, import);
    const std::string name = fmt::format("{}.{}", import.name, expr.name);
    if (expr.name.starts_with('_') || (known && tree_.statements[found->second].kind == Kind::Import)) {
      return error("E0803", expr.name_span, fmt::format("`{}` is the file's own", name), "",
                   {"names that begin with _, and imports, are not seen from outside"});
    }
    const bool is_def = known && tree_.statements[found->second].kind == Kind::Def;
    if (known && is_def == call) {
      expr.reference = {call ? Reference::Kind::Definition : Reference::Kind::Global, found->second};
      uses_[current_].push_back({found->second, expr.name_span});
      return;
    }
    if (known) {
      return error(
          call ? "E0804" : "E0803", expr.name_span, fmt::format("`{}` is a {}", name, is_def ? "function" : "value"),
          "", {is_def ? fmt::format("call it: {}(...)", name) : fmt::format("for a product write {}*(...)", name)});
    }
    std::vector<std::string_view> names;
    for (const Statement& other : statements_of(module)) {
      const bool fits = has_name(other) && other.kind != Kind::Import && (other.kind == Kind::Def) == call;
      if (fits && !other.name.starts_with('_')) names.push_back(other.name);
    }
    error(call ? "E0804" : "E0803", expr.name_span,
          fmt::format("`{}` has no {} `{}`", import.label, call ? "function" : "name", expr.name), "",
          {did_you_mean(expr.name, names)});
  }

  void refer_to_objects(Expr& expr, const Statement& import) {
    const Module& module = tree_.modules[import.target];
    for (std::uint32_t i = module.begin; i < module.end; ++i) {
      if (tree_.statements[i].kind == Kind::Object) uses_[current_].push_back({i, expr.name_span});
    }
    expr.reference = {Reference::Kind::Objects, import.target};
  }

  // Checks the values that an import gives for parameters.
  void check_values(const Statement& import) {
    std::vector<std::string_view> names;
    for (const Statement& statement : statements_of(tree_.modules[import.target])) {
      if (statement.kind == Kind::Param) names.push_back(statement.name);
    }
    for (const Argument& value : import.fields) {
      if (std::ranges::find(names, value.name) == names.end()) {
        error("E0805", value.name_span, fmt::format("`{}` has no parameter `{}`", import.label, value.name), "",
              {names.empty() ? "it has none: its functions take arguments" : did_you_mean(value.name, names)});
      }
      if (&*std::ranges::find(import.fields, value.name, &Argument::name) != &value) {
        error("E0010", value.name_span, fmt::format("`{}` is given twice", value.name), "", {"keep one of them"});
      }
    }
  }

  void warn_of_unused_imports() {
    for (current_ = 0; current_ < tree_.statements.size(); ++current_) {
      const Statement& statement = tree_.statements[current_];
      if (statement.kind != Kind::Import || imported_[current_] || statement.name.starts_with('_')) continue;
      warning("W0405", statement.name_span, fmt::format("unused import `{}`", statement.name), "", {"remove it"});
    }
  }

  [[gnu::noinline]] void resolve_name(Expr& expr) {
    for (std::size_t i = locals_.size(); i-- > 0;) {
      if (locals_[i].name != expr.name) continue;
      locals_[i].used = true;
      expr.reference = {Reference::Kind::Local, locals_[i].slot};
      return;
    }
    const auto found = globals().find(expr.name);
    if (found != globals().end()) return refer(expr, found->second);
    const std::string_view axes = "xyz";
    const std::size_t axis = expr.name.size() == 1 ? axes.find(expr.name) : std::string_view::npos;
    if (axis != std::string_view::npos) {
      expr.reference = {Reference::Kind::Coordinate, static_cast<std::uint32_t>(axis)};
    } else if (const auto constant = formula_constant(expr.name)) {
      expr.reference = {Reference::Kind::Constant, 0, *constant};
    } else {
      report_unknown(expr);
    }
  }

  void refer(Expr& expr, std::uint32_t number) {
    const Statement& target = tree_.statements[number];
    if (target.kind == Kind::Import) {
      imported_[number] = true;
      error("E0803", expr.span, fmt::format("`{}` is a file", expr.name), "",
            {fmt::format("a name of it is {0}.name, all that is to be seen of it {0}.scene", expr.name)});
      return;
    }
    if (target.kind == Kind::Def) {
      error("E0803", expr.span, fmt::format("`{}` is a function", expr.name), "",
            {fmt::format("call it: {}(...)", expr.name)});
      return;
    }
    const bool in_param = tree_.statements[current_].kind == Kind::Param;
    if (in_param && (target.kind != Kind::Param || number >= current_)) {
      error("E0402", expr.span, fmt::format("`{}` has no value yet", expr.name), "",
            {"a parameter can use the parameters before it"});
      return;
    }
    expr.reference = {Reference::Kind::Global, number};
    uses_[current_].push_back({number, expr.span});
  }

  void report_unknown(const Expr& expr) {
    std::vector<std::string> help;
    if (find_word(expr.name)) {
      help = {fmt::format("`{0}` is a function: {0}(...)", expr.name)};
    } else if (diagnostics_.errors() < kMaxSuggestions) {
      help = {did_you_mean(expr.name, known_names())};
    }
    error("E0803", expr.span, fmt::format("unknown name `{}`", expr.name), "", std::move(help));
  }

  std::vector<std::string_view> known_names() const {
    std::vector<std::string_view> names;
    for (const Local& local : locals_) names.push_back(local.name);
    const Module& module = tree_.modules[tree_.statements[current_].module];
    for (const Statement& statement : statements_of(module)) {
      if (has_name(statement) && statement.kind != Kind::Def) names.push_back(statement.name);
    }
    for (const char* name : {"x", "y", "z", "pi", "e", "tau"}) names.emplace_back(name);
    return names;
  }

  [[gnu::noinline]] void resolve_function(Expr& expr) {
    const auto found = globals().find(expr.name);
    const bool is_def = found != globals().end() && tree_.statements[found->second].kind == Kind::Def;
    if (is_def) {
      expr.reference = {Reference::Kind::Definition, found->second};
      uses_[current_].push_back({found->second, expr.name_span});
      if (tree_.statements[current_].kind == Kind::Param) {
        error("E0402", expr.name_span, fmt::format("`{}` cannot be called yet", expr.name), "",
              {"parameters have their values before anything else"});
      }
      return;
    }
    expr.word = find_word(expr.name);
    if (expr.word) return;
    const bool value = found != globals().end() || formula_constant(expr.name) ||
                       std::ranges::any_of(locals_, [&](const Local& local) { return local.name == expr.name; });
    std::vector<std::string_view> known = all_words();
    for (const Statement& statement : statements_of(tree_.modules[tree_.statements[current_].module])) {
      if (diagnostics_.full()) break;
      if (statement.kind == Kind::Def) known.push_back(statement.name);
    }
    error("E0804", expr.name_span, fmt::format("unknown function `{}`", expr.name), "",
          {value ? fmt::format("`{0}` is a value; for a product write {0}*(...)", expr.name)
                 : nearest_of(expr.name, known)});
  }

  // Suggests only the nearest of the 160 words.
  static std::string nearest_of(std::string_view name, const std::vector<std::string_view>& known) {
    if (const std::string_view help = foreign_help(name); !help.empty()) return std::string(help);
    const std::string_view meant = suggest(name, known);
    return meant.empty() ? "docs/reference/gallery.md shows all nodes; a function of one's own is "
                           "`def name(a, b) = ...`"
                         : fmt::format("did you mean `{}`?", meant);
  }

  Tree& tree_;
  Diagnostics& diagnostics_;
  std::vector<std::unordered_map<std::string_view, std::uint32_t>> globals_;  // [module] number of the statement
  std::vector<bool> imported_;            // [statement] true if a name of the import is used
  std::vector<std::vector<UseOf>> uses_;  // [statement]
  std::uint32_t current_ = 0;
  std::vector<Local> locals_;
  std::uint32_t slots_ = 0;
};

}  // namespace

std::optional<std::vector<std::uint32_t>> resolve_names(Tree& tree, Diagnostics& diagnostics) {
  return Resolver(tree, diagnostics).run();
}

}  // namespace fathom::compiler::text
