//===- Messages.cpp - clang's preprocessor messages as ours ---------------===//
#include "Messages.h"

#include "frontend/preprocessor/FileSearch.h"
#include "support/ClosestName.h"

#include <clang/Basic/DiagnosticLex.h>
#include <clang/Lex/Lexer.h>
#include <clang/Lex/MacroInfo.h>

#include <llvm/ADT/SmallString.h>

namespace rtsl {

namespace diag = clang::diag;

struct Messages::Place {
  Origin origin;
  std::string_view text; // there

  /// The range from here to `end` in the same file.
  Origin to(std::uint32_t end) const {
    Origin result = origin;
    result.range.end = end;
    return result;
  }
};

namespace {

std::string argument(const clang::Diagnostic &info, unsigned index) {
  using Engine = clang::DiagnosticsEngine;
  switch (info.getArgKind(index)) {
  case Engine::ak_std_string:
    return info.getArgStdStr(index);
  case Engine::ak_c_string:
    return info.getArgCStr(index);
  case Engine::ak_identifierinfo: {
    const auto *name = reinterpret_cast<const clang::IdentifierInfo *>(info.getRawArg(index));
    return name ? name->getName().str() : std::string();
  }
  default:
    return {};
  }
}

/// The end of a line, without a comment at its end and the spaces before it.
std::uint32_t restOfLine(std::string_view text, std::size_t from) {
  std::size_t end = std::min(text.find('\n', from), text.size());
  for (const std::string_view comment : {"//", "/*"})
    end = std::min(end, text.find(comment, from));
  while (end > from && (text[end - 1] == ' ' || text[end - 1] == '\t' || text[end - 1] == '\r'))
    --end;
  return static_cast<std::uint32_t>(end);
}

} // namespace

/// Files that are included.
bool Messages::reportFile(const clang::Diagnostic &info, const Place &at) {
  switch (info.getID()) {
  case diag::err_pp_file_not_found:
  case diag::err_pp_file_not_found_angled_include_not_fatal:
  case diag::err_pp_file_not_found_typo_not_fatal: {
    const Origin directive = directiveAround(at.origin);
    if (session->sources.text(directive.range) != "include") { // an extension of clang's
      reportUnknownDirective(directive);
      session->stop();
      return true;
    }
    const std::string name = argument(info, 0);
    const SourceRange range = at.origin.range;
    if (unreadable == range) // the file exists
      return true;
    const std::string_view text = session->sources.text(range.file);
    const bool isAngled = range.begin < text.size() && text[range.begin] == '<';
    Origin shown = at.origin;
    SourceRange inside;
    const bool isWritten = text.substr(range.begin + std::size_t{1}, name.size()) == name;
    if (isWritten) {
      shown.range.end = range.begin + static_cast<std::uint32_t>(name.size()) + 2;
      inside = {range.file, range.begin + 1, shown.range.end - 1};
    }
    Diagnostic &diagnostic = session->report(Code::includeNotFound, shown, name);
    explainSearch(diagnostic, name, session->searchedFolders(range.file, isAngled), inside);
    if (info.getID() == diag::err_pp_file_not_found_angled_include_not_fatal)
      diagnostic.fix({range.file, range.begin, shown.range.end}, "\"" + name + "\"");
    session->isUsable = false;
    return true;
  }
  case diag::err_pp_error_opening_file:
  case diag::err_cannot_open_file: {
    const bool isNoFile =
        argument(info, 1) == std::make_error_code(std::errc::invalid_argument).message();
    const std::string path = argument(info, 0);
    unreadable = at.origin.range;
    session->report(Code::includeUnreadable, at.origin,
                    path.compare(0, 2, "./") == 0 ? path.substr(2) : path,
                    isNoFile ? "it is not a regular file" : argument(info, 1));
    session->isUsable = false;
    return true;
  }
  case diag::err_pp_expects_filename:
  case diag::err_pp_empty_filename:
    session->report(Code::badIncludeName, at.origin);
    session->isUsable = false;
    return true;
  case diag::err_pp_include_too_deep:
    session->report(Code::includesTooDeep, at.origin, maxIncludeDepth);
    session->stop();
    return true;
  case diag::err_sloc_space_too_large:
  case diag::err_file_too_large:
    session->report(Code::includesTooMuch, at.origin, fmt::format("{} MB", maxIncludedBytes >> 20));
    session->stop();
    return true;
  default:
    return false;
  }
}

/// `#if` and what belongs to it.
bool Messages::reportConditional(const clang::Diagnostic &info, const Place &at) {
  switch (info.getID()) {
  case diag::err_pp_unterminated_conditional: {
    const auto size =
        static_cast<std::uint32_t>(session->sources.text(at.origin.range.file).size());
    session->report(Code::unterminatedCondition, at.origin, at.text)
        .label({at.origin.range.file, size, size}, "the file ends here");
    session->isUsable = false;
    return true;
  }
  case diag::err_pp_endif_without_if:
  case diag::pp_err_else_without_if:
  case diag::pp_err_elif_without_if:
    if (at.text != "elifdef" && at.text != "elifndef") // unknown directives: reported
      session->report(Code::conditionWithoutIf, at.origin, at.text);
    return true;
  case diag::pp_err_else_after_else:
  case diag::pp_err_elif_after_else: {
    Diagnostic &diagnostic = session->report(Code::afterElse, at.origin, at.text);
    const clang::SourceLocation opened = watcher->innermostIf();
    if (const clang::SourceLocation earlier = watcher->elseOf(opened);
        earlier.isValid() && earlier != info.getLocation())
      diagnostic.label(session->origins.of(earlier).range, "the `#else`");
    if (opened.isValid())
      diagnostic.label(session->origins.of(opened).range, "the `#if`");
    return true;
  }
  default:
    return false;
  }
}

/// The condition of `#if`.
bool Messages::reportCondition(const clang::Diagnostic &info, const Place &at) {
  const auto bad = [&](const std::string &why) -> Diagnostic & {
    return session->report(Code::badCondition, at.origin, why);
  };
  switch (info.getID()) {
  case diag::warn_pp_undef_identifier:
  case diag::warn_pp_undef_true_identifier: {
    const std::string name(at.text);
    undefined = at.origin.range;
    Diagnostic &diagnostic = session->report(Code::undefinedInCondition, at.origin, name);
    std::vector<std::string> macros;
    for (const auto &[macro, state] : session->preprocessor.macros())
      if (macro->hasMacroDefinition())
        macros.push_back(macro->getName().str());
    std::sort(macros.begin(), macros.end());
    if (name == "true" || name == "false")
      diagnostic.fix(at.origin.range, name == "true" ? "1" : "0");
    else if (const std::string closest = closestName(name, macros); !closest.empty())
      diagnostic.fix(at.origin.range, closest);
    else
      diagnostic.note(fmt::format("use `defined({})` to test whether it is defined", name));
    return true;
  }
  case diag::err_pp_expected_value_in_expr:
    bad("a value is missing");
    return true;
  case diag::err_pp_expr_bad_token_start_expr:
    bad(fmt::format("a value cannot begin with `{}`", at.text));
    return true;
  case diag::err_pp_expr_bad_token_binop:
    bad(fmt::format("`{}` is not an operator here", at.text));
    return true;
  case diag::err_pp_expr_bad_token_lparen:
    if (!(undefined == at.origin.range))
      bad(fmt::format("there is no macro `{}` with arguments", argument(info, 0)));
    return true;
  case diag::err_pp_expected_rparen:
    bad("`)` is missing");
    return true;
  case diag::err_pp_expected_after:
    bad("`defined` takes a name, or a name in parentheses");
    return true;
  case diag::err_pp_expected_eol:
    bad("extra tokens after its end");
    return true;
  case diag::err_pp_division_by_zero:
  case diag::err_pp_remainder_by_zero:
    bad("it divides by zero");
    return true;
  case diag::err_pp_illegal_floating_literal:
    bad("only integers are allowed");
    return true;
  case diag::err_pp_colon_without_question:
    bad("`:` has no `?`");
    return true;
  case diag::ext_pp_comma_expr:
    bad("`,` is not an operator here");
    return true;
  case diag::err_expected:
    bad("`:` is missing");
    return true;
  case diag::warn_pp_expr_overflow:
  case diag::ext_integer_literal_too_large_for_signed:
  case diag::err_integer_literal_too_large:
    bad("it does not fit into 64 bits");
    return true;
  case diag::err_invalid_suffix_constant:
    bad(fmt::format("`{}` is not a number", at.text));
    return true;
  case diag::err_invalid_digit:
    bad("a number has an invalid digit");
    return true;
  default:
    return false;
  }
}

/// The text of `#error` or `#warning`, which may have none.
static std::string afterSpace(const std::string &text) {
  return text.empty() ? text : " " + text;
}

/// `#define` and `#undef`.
bool Messages::reportDefinition(const clang::Diagnostic &info, const Place &at) {
  const auto parameters = [&](const char *what) {
    session->report(Code::badMacroParameters, at.origin, what);
    return true;
  };
  const auto body = [&](const char *what) {
    session->report(Code::badMacroBody, at.origin, what);
    return true;
  };
  switch (info.getID()) {
  case diag::ext_pp_macro_redef:
    if (isOfTheLanguage(argument(info, 0))) {
      session->report(Code::predefinedMacro, at.origin, at.text);
      return true;
    }
    last = &session->report(Code::macroRedefined, at.origin, argument(info, 0));
    last->note(fmt::format("write `#undef {}` before it", argument(info, 0)));
    return true;
  case diag::ext_pp_redef_builtin_macro:
  case diag::ext_pp_undef_builtin_macro:
    session->report(Code::predefinedMacro, at.origin, at.text);
    return true;
  case diag::err_defined_macro_name:
    session->report(Code::badMacroName, at.origin, "defined");
    return true;
  case diag::err_pp_macro_not_identifier:
    session->report(Code::badMacroName, at.origin, at.text);
    return true;
  case diag::err_pp_missing_macro_name:
    session->report(Code::missingMacroName, at.origin);
    return true;
  case diag::ext_c99_whitespace_required_after_macro_name:
  case diag::ext_missing_whitespace_after_macro_name:
  case diag::warn_missing_whitespace_after_macro_name:
    session->report(Code::noSpaceAfterMacroName, at.origin);
    return true;
  case diag::err_pp_missing_rparen_in_macro_def:
    return parameters("`)` is missing");
  case diag::err_pp_expected_ident_in_arg_list:
    return parameters("a name is missing");
  case diag::err_pp_expected_comma_in_arg_list:
    return parameters("`,` is missing");
  case diag::err_pp_invalid_tok_in_arg_list:
    return parameters("only names are allowed");
  case diag::err_pp_duplicate_name_in_arg_list:
    return parameters("a name is repeated");
  case diag::ext_named_variadic_macro:
    return parameters("`...` follows a name");
  case diag::err_pp_stringize_not_parameter:
    return body("`#` is not followed by a parameter");
  case diag::err_paste_at_start:
    return body("`##` has no token before it");
  case diag::err_paste_at_end:
    return body("`##` has no token after it");
  case diag::ext_pp_bad_vaargs_use:
    return body("`__VA_ARGS__` is allowed only in macros with `...`");
  default:
    return false;
  }
}

/// Uses of macros.
bool Messages::reportUse(const clang::Diagnostic &info, const Place &at) {
  switch (info.getID()) {
  case diag::err_too_many_args_in_macro_invoc:
  case diag::err_too_few_args_in_macro_invoc:
  case diag::err_unterm_macro_invoc:
    misuse = info.getID(); // reported when clang names the macro, in a note
    misused = at.origin;
    session->isUsable = false;
    return true;
  case diag::err_pp_bad_paste:
    session->report(Code::badPaste, at.origin, argument(info, 0));
    return true;
  case diag::ext_embedded_directive:
  case diag::err_embedded_directive:
    session->report(Code::directiveInArguments, directiveAround(at.origin),
                    session->sources.text(directiveAround(at.origin).range));
    session->stop();
    return true;
  default:
    return false;
  }
}

/// Adds the location of the macro of the last message, or of its earlier definition.
void Messages::addNote(const clang::Diagnostic &info) {
  const Origin place = session->origins.of(info.getLocation());
  const bool isShown = place.range.file != 0;
  if (info.getID() == diag::note_previous_definition && last && isShown) {
    last->label(place.range, "defined here first");
  } else if (info.getID() == diag::note_macro_here && misuse) {
    const std::string name = argument(info, 0);
    const clang::MacroInfo *macro =
        session->preprocessor.getMacroInfo(session->preprocessor.getIdentifierInfo(name));
    Diagnostic *diagnostic = nullptr;
    if (misuse == diag::err_unterm_macro_invoc) {
      diagnostic = &session->report(Code::unterminatedMacroCall, misused, name);
    } else {
      const std::size_t taken = macro ? macro->getNumParams() : 0;
      diagnostic = &session->report(Code::macroArgumentCount, misused, name,
                                    fmt::format("{} argument{}", taken, taken == 1 ? "" : "s"),
                                    misuse == diag::err_too_many_args_in_macro_invoc
                                        ? "this is one too many"
                                        : "here is one too few");
    }
    if (isShown)
      diagnostic->label(place.range, "defined here");
    misuse = 0;
  }
}

/// The token after the `#` at the beginning of a line.
Origin Messages::directiveAround(const Origin &place) const {
  const std::string_view text = session->sources.text(place.range.file);
  const std::size_t lineBegin = text.rfind('\n', place.range.begin) + 1; // 0 in the first line
  const std::size_t hash = std::min(text.find('#', lineBegin), text.size());
  const std::size_t begin = std::min(text.find_first_not_of(" \t", hash + 1), text.size());
  const std::size_t end = std::min(text.find_first_of(" \t\r\n\"</(", begin), text.size());
  return {{place.range.file, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)},
          place.expansion};
}

void Messages::reportUnknownDirective(const Origin &word) {
  const std::string name(session->sources.text(word.range));
  Diagnostic &diagnostic = session->report(Code::unknownDirective, word, name);
  static const std::vector<std::string> directives = {
      "define", "undef",   "if",   "ifdef", "ifndef",  "elif",  "else",
      "endif",  "include", "line", "error", "warning", "pragma"};
  if (name == "version" || name == "extension") {
    const std::string_view text = session->sources.text(word.range.file);
    const std::size_t begin = text.rfind('#', word.range.begin);
    const std::size_t end = std::min(text.find('\n', word.range.end), text.size());
    diagnostic.note("RTSL has one version and no extensions")
        .fix({word.range.file, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)},
             "", true);
  } else if (name == "import") {
    diagnostic.note("write `import \"file.rtsl\";`, without `#`");
  } else if (name.find_first_not_of("0123456789") == std::string::npos) {
    diagnostic.note("write `#line`");
  } else if (const std::string closest = closestName(name, directives); !closest.empty()) {
    diagnostic.fix(word.range, closest);
  }
}

/// Other directives, and directives that are not allowed here.
bool Messages::reportDirective(const clang::Diagnostic &info, const Place &at) {
  switch (info.getID()) {
  case diag::err_pp_invalid_directive:
    reportUnknownDirective(at.origin);
    return true;
  case diag::ext_c23_pp_directive:
    session->report(Code::unknownDirective, at.origin, at.text)
        .note(fmt::format("write `#elif {}defined(NAME)`", at.text == "elifndef" ? "!" : ""));
    return true;
  case diag::err_pp_hash_error:
    session->report(Code::userError, at.origin, afterSpace(argument(info, 0)));
    return true;
  case diag::pp_hash_warning:
    session->report(Code::userWarning, at.origin, afterSpace(argument(info, 0)));
    return true;
  case diag::ext_pp_extra_tokens_at_eol: {
    const std::string_view text = session->sources.text(at.origin.range.file);
    std::uint32_t end = restOfLine(text, at.origin.range.begin);
    session->report(Code::extraAfterDirective, at.to(std::max(end, at.origin.range.end)),
                    argument(info, 0));
    return true;
  }
  case diag::err_pp_line_requires_integer:
  case diag::err_pp_line_digit_sequence:
  case diag::err_pp_line_invalid_filename:
  case diag::ext_pp_line_zero:
  case diag::ext_pp_line_too_big:
    session->report(Code::badLineDirective, at.origin);
    return true;
  case diag::ext_pp_gnu_line_directive:
    reportUnknownDirective(directiveAround(at.origin));
    session->stop();
    return true;
  case diag::err_unterminated_block_comment: {
    Origin opening = at.origin;
    opening.range.end = opening.range.begin + 2;
    session->report(Code::unterminatedComment, opening);
    session->isUsable = false;
    return true;
  }
  default:
    return false;
  }
}

void Messages::HandleDiagnostic(clang::DiagnosticsEngine::Level level,
                                const clang::Diagnostic &info) {
  DiagnosticConsumer::HandleDiagnostic(level, info);
  if (!session || session->isStopped || info.getLocation().isInvalid())
    return;
  if (level == clang::DiagnosticsEngine::Note) {
    addNote(info);
    return;
  }
  last = nullptr;
  Place at{session->origins.of(info.getLocation()), {}};
  if (at.origin.range.file == 0)
    return;
  at.text = session->sources.text(at.origin.range);
  if (reportFile(info, at) || reportConditional(info, at) || reportCondition(info, at) ||
      reportDefinition(info, at) || reportUse(info, at) || reportDirective(info, at))
    return;

  switch (info.getID()) {
  case diag::err_character_not_allowed: // tokens and characters of the text: reported by our lexer
  case diag::err_character_not_allowed_identifier:
  case diag::err_invalid_utf8:
    return;
  default:
    break;
  }
  if (level < clang::DiagnosticsEngine::Error)
    return;
  llvm::SmallString<128> text;
  info.FormatDiagnostic(text);
  session->report(Code::badDirective, at.origin, text.str().str());
  session->isUsable = false;
}

} // namespace rtsl
