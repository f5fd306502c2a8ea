#include "compiler/frontend/text/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>

#include "compiler/frontend/formula.h"
#include "compiler/frontend/suggest.h"
#include "compiler/frontend/text/vocabulary.h"

namespace fathom::compiler::text {
namespace {

using Kind = Statement::Kind;

// Errors that are printed: of a file of many names looking for the nearest takes a while.
constexpr std::size_t kMostSuggestions = 20;

bool has_name(const Statement& statement) {
  return statement.kind == Kind::Param || statement.kind == Kind::Let || statement.kind == Kind::Def;
}

class Resolver {
 public:
  Resolver(Tree& tree, Diagnostics& diagnostics) : tree_(tree), diagnostics_(diagnostics) {}

  std::optional<std::vector<std::uint32_t>> run() {
    uses_.resize(tree_.statements.size());
    for (std::uint32_t i = 0; i < tree_.statements.size(); ++i) declare_global(i);
    for (current_ = 0; current_ < tree_.statements.size(); ++current_) resolve_statement(tree_.statements[current_]);
    std::vector<std::uint32_t> order = in_order();
    return has_circle_ ? std::nullopt : std::optional(std::move(order));
  }

 private:
  struct Local {
    std::string_view name;
    Span span;
    std::uint32_t slot;
    bool used;
  };
  struct UseOf {
    std::uint32_t statement;
    Span span;
  };

  void declare_global(std::uint32_t number) {
    const Statement& statement = tree_.statements[number];
    if (!has_name(statement)) return;
    check_name(statement.name, statement.name_span);
    const auto [found, is_new] = globals_.emplace(statement.name, number);
    if (!is_new) report_twice(statement.name, statement.name_span);
    if (statement.kind == Kind::Def && find_word(statement.name)) {
      diagnostics_.warning("W0406", statement.name_span, fmt::format("`{}` is a function already", statement.name), "",
                           {"this one takes its place in the file: choose another name"});
    }
  }

  void check_name(std::string_view name, Span span) {
    if (name != "x" && name != "y" && name != "z" && !formula_constant(name)) return;
    diagnostics_.error("E0407", span,
                       fmt::format("the name `{}` is {}", name,
                                   formula_constant(name) ? "a constant of formulas" : "a coordinate"),
                       "", {"choose another name"});
  }

  void report_twice(std::string_view name, Span span) {
    diagnostics_.error("E0802", span, fmt::format("`{}` is declared twice", name), "",
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
    resolve(*statement.value);
    leave(0, true);
    statement.slots = slots_;
  }

  // A name that is not declared yet since `from`.
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

  // The names since `from` end; those that nothing used are reported if `warn`.
  void leave(std::size_t from, bool warn) {
    for (std::size_t i = from; i < locals_.size() && warn; ++i) {
      if (locals_[i].used || locals_[i].name[0] == '_') continue;
      diagnostics_.warning("W0405", locals_[i].span, fmt::format("unused name `{}`", locals_[i].name), "",
                           {"remove it, or begin it with _ to keep it"});
    }
    locals_.resize(from);
  }

  void resolve(Expr& expr) {
    using enum Expr::Kind;
    const std::size_t from = locals_.size();
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
        resolve_function(expr);
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

  void resolve_name(Expr& expr) {
    for (std::size_t i = locals_.size(); i-- > 0;) {
      if (locals_[i].name != expr.name) continue;
      locals_[i].used = true;
      expr.reference = {Reference::Kind::Local, locals_[i].slot};
      return;
    }
    const auto found = globals_.find(expr.name);
    if (found != globals_.end()) return refer(expr, found->second);
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
    if (target.kind == Kind::Def) {
      diagnostics_.error("E0803", expr.span, fmt::format("`{}` is a function", expr.name), "",
                         {fmt::format("call it: {}(...)", expr.name)});
      return;
    }
    const bool in_param = tree_.statements[current_].kind == Kind::Param;
    if (in_param && (target.kind != Kind::Param || number >= current_)) {
      diagnostics_.error("E0402", expr.span, fmt::format("`{}` has no value yet", expr.name), "",
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
    } else if (diagnostics_.errors() < kMostSuggestions) {
      help = {did_you_mean(expr.name, known_names())};
    }
    diagnostics_.error("E0803", expr.span, fmt::format("unknown name `{}`", expr.name), "", std::move(help));
  }

  std::vector<std::string_view> known_names() const {
    std::vector<std::string_view> names;
    for (const Local& local : locals_) names.push_back(local.name);
    for (const Statement& statement : tree_.statements) {
      if (has_name(statement) && statement.kind != Kind::Def) names.push_back(statement.name);
    }
    for (const char* name : {"x", "y", "z", "pi", "e", "tau"}) names.emplace_back(name);
    return names;
  }

  void resolve_function(Expr& expr) {
    const auto found = globals_.find(expr.name);
    const bool is_def = found != globals_.end() && tree_.statements[found->second].kind == Kind::Def;
    if (is_def) {
      expr.reference = {Reference::Kind::Definition, found->second};
      uses_[current_].push_back({found->second, expr.name_span});
      if (tree_.statements[current_].kind == Kind::Param) {
        diagnostics_.error("E0402", expr.name_span, fmt::format("`{}` cannot be called yet", expr.name), "",
                           {"parameters have their values before anything else"});
      }
      return;
    }
    expr.word = find_word(expr.name);
    if (expr.word) return;
    const bool value = found != globals_.end() || formula_constant(expr.name) ||
                       std::ranges::any_of(locals_, [&](const Local& local) { return local.name == expr.name; });
    std::vector<std::string_view> known = all_words();
    for (const Statement& statement : tree_.statements) {
      if (diagnostics_.full()) break;
      if (statement.kind == Kind::Def) known.push_back(statement.name);
    }
    diagnostics_.error("E0804", expr.name_span, fmt::format("unknown function `{}`", expr.name), "",
                       {value ? fmt::format("`{0}` is a value; for a product write {0}*(...)", expr.name)
                              : nearest_of(expr.name, known)});
  }

  // Of 160 words only those that are near.
  static std::string nearest_of(std::string_view name, const std::vector<std::string_view>& known) {
    const std::string_view meant = suggest(name, known);
    return meant.empty() ? "docs/GALLERY.md shows all nodes; a function of one's own is `def name(a, b) = ...`"
                         : fmt::format("did you mean `{}`?", meant);
  }

  // Depth first, without recursion: chains of names may be as long as the file.
  std::vector<std::uint32_t> in_order() {
    enum class State : std::uint8_t { New, Open, Done };
    std::vector<State> states(uses_.size(), State::New);
    std::vector<std::uint32_t> order;
    struct Visit {
      std::uint32_t statement;
      std::size_t next;
    };
    for (std::uint32_t root = 0; root < uses_.size(); ++root) {
      std::vector<Visit> open;
      if (states[root] == State::New) open.push_back({root, 0}), states[root] = State::Open;
      while (!open.empty()) {
        Visit& top = open.back();
        if (top.next == uses_[top.statement].size()) {
          states[top.statement] = State::Done;
          order.push_back(top.statement);
          open.pop_back();
          continue;
        }
        const UseOf use = uses_[top.statement][top.next++];
        if (states[use.statement] == State::New) {
          states[use.statement] = State::Open;
          open.push_back({use.statement, 0});
        } else if (states[use.statement] == State::Open) {
          std::vector<std::uint32_t> circle;
          for (const Visit& visit : open) circle.push_back(visit.statement);
          circle.erase(circle.begin(), std::ranges::find(circle, use.statement));
          report_circle(circle, use.span);
        }
      }
    }
    return order;
  }

  void report_circle(const std::vector<std::uint32_t>& circle, Span span) {
    has_circle_ = true;
    std::string names;
    for (const std::uint32_t number : circle) names += fmt::format("`{}` uses ", tree_.statements[number].name);
    names += fmt::format("`{}`", tree_.statements[circle[0]].name);
    const bool def = tree_.statements[circle[0]].kind == Kind::Def;
    diagnostics_.error("E0806", span,
                       fmt::format("`{}` {} itself", tree_.statements[circle[0]].name, def ? "calls" : "is made of"),
                       names, {"what is done again and again is a list, [for i in 0..10: ...], or a `fold`"});
  }

  Tree& tree_;
  Diagnostics& diagnostics_;
  std::unordered_map<std::string_view, std::uint32_t> globals_;  // the statement's number
  std::vector<std::vector<UseOf>> uses_;                         // [statement]
  std::uint32_t current_ = 0;
  std::vector<Local> locals_;
  std::uint32_t slots_ = 0;
  bool has_circle_ = false;
};

}  // namespace

std::optional<std::vector<std::uint32_t>> resolve_names(Tree& tree, Diagnostics& diagnostics) {
  return Resolver(tree, diagnostics).run();
}

}  // namespace fathom::compiler::text
