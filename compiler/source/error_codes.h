// The codes of all diagnostics. Each code has one meaning, which never changes.
// Tested by: tests/compiler/source/diagnostics_test.cpp (every code has a file in tests/golden/diagnostics)
#pragma once

#include <string_view>

namespace fathom::compiler {

struct ErrorCode {
  std::string_view code;
  std::string_view meaning;
};

inline constexpr ErrorCode kErrorCodes[] = {
    // E00xx: the text is not JSON
    {"E0001", "something else was expected here"},
    {"E0002", "the file ends too early"},
    {"E0003", "malformed string"},
    {"E0004", "malformed number"},
    {"E0005", "a word or character that JSON does not have"},
    {"E0006", "malformed comment"},
    {"E0007", "the file is not UTF-8 text"},
    {"E0008", "the file goes beyond a limit of the reader"},
    {"E0009", "the number is too large for any float"},
    {"E0010", "the same property twice"},
    // E01xx: properties and values
    {"E0101", "a value of the wrong type"},
    {"E0102", "unknown property"},
    {"E0103", "missing property"},
    {"E0104", "a value out of range"},
    {"E0105", "unknown version of the scene format"},
    {"E0106", "properties that exclude each other"},
    {"E0107", "an empty list"},
    {"E0108", "not one of the choices"},
    {"E0109", "patterns nested too deep"},
    // E02xx: names
    {"E0201", "unknown type of node"},
    {"E0202", "unknown material"},
    {"E0203", "unknown named node"},
    {"E0204", "a named node within itself"},
    // E03xx: geometry
    {"E0301", "a degenerate parameter"},
    {"E0302", "parameters that do not fit together"},
    {"E0303", "the camera looks at its own position"},
    {"E0304", "the camera's up is its direction of view"},
    {"E0305", "the program would be too long for the machine"},
    {"E0306", "a solid where an outline is needed, or the other way round"},
    {"E0307", "an outline placed out of its plane"},
    {"E0308", "numbers beyond those of float"},
    {"E0309", "a sun below the horizon"},
    {"E0310", "a light that shines on its own position"},
    {"E0311", "a file named in the scene that cannot be read"},
    {"E0312", "the scene goes beyond a limit"},
    // E04xx: formulas and parameters
    {"E0401", "malformed formula"},
    {"E0402", "unknown name in a formula"},
    {"E0403", "unknown function in a formula"},
    {"E0404", "a function with too few or too many arguments"},
    {"E0405", "x, y or z where there is no point"},
    {"E0406", "a formula nested too deep"},
    {"E0407", "a name that a parameter or definition cannot have"},
    {"E0408", "a parameter out of its range"},
    {"E0409", "a number in a formula that float cannot hold"},
    {"E0410", "a number of times that is not a constant whole number"},
    // E05xx: the command line's values for a scene
    {"E0501", "a value for a parameter that the scene does not have"},
    {"E0502", "a value for a parameter out of its range"},
    // E06xx: foreign formats
    {"E0601", "unknown operation in an expression list"},
    {"E0602", "an operation with too few or too many operands"},
    {"E0603", "an operand that no line above has as its name"},
    {"E0604", "a name given to two lines of an expression list"},
    {"E0605", "a constant of an expression list that is not a number"},
    {"E0606", "an expression list without a line"},
    {"E0611", "unknown kind of nested node"},
    {"E0612", "a property of a nested node that is missing or of the wrong type"},
    {"E0613", "a matrix that does not only turn and move"},
    {"E0614", "a box whose edges are rounded in ways that are not known here"},
    // E07xx: compiled scenes and their listings
    {"E0701", "a compiled scene or a listing that is none, of no sound program, or beyond a limit"},
    // E08xx: scenes in Fathom's own notation
    {"E0801", "a statement was expected"},
    {"E0802", "a name declared twice"},
    {"E0803", "unknown name"},
    {"E0804", "unknown function"},
    {"E0805", "arguments that a function does not take"},
    {"E0806", "a name that is made of itself, or a function that calls itself"},
    {"E0807", "a value of the wrong kind"},
    {"E0808", "a condition that varies with x, y and z"},
    {"E0809", "a range of fractions"},
    {"E0810", "a file that cannot be imported"},
    {"E0811", "what a scene requires does not hold"},
    {"E0812", "a line that goes on with a statement and is not indented"},
    {"E0813", "operators that need parentheses"},
    // W04xx: warnings
    {"W0401", "unused material"},
    {"W0402", "unused named node"},
    {"W0403", "large numbers cancel in float"},
    {"W0404", "unused parameter"},
    {"W0405", "unused name"},
    {"W0406", "a function in the place of a built-in one"},
    {"W0407", "a value that the scene shows"},
    // W05xx: warnings about scenes that are valid but surely not meant, or expensive (compiler/analysis/lints.h)
    {"W0501", "a part that never shows"},
    {"W0502", "an operation that leaves nothing"},
    {"W0503", "a cut that cuts nothing off"},
    {"W0504", "a repetition that evaluates many copies"},
    {"W0505", "a blend too wide for what it joins"},
    {"W0506", "a part thinner than floats tell apart"},
    {"W0507", "an area light that emits no light"},
    {"W0508", "steps many times shorter"},
    {"W0509", "a formula without a bound"},
    {"W0510", "the camera is inside a solid"},
    {"W0511", "an offset of what is no distance"},
    {"W0512", "a part too small for where it stands"},
    {"W0513", "a scene too small for numbers"},
    {"W0514", "a field that is not a number somewhere"},
    {"W0515", "no light reaches the camera"},
    {"W0516", "nothing is in view"},  // runtime/cli/picture/image_warning.cpp
    {"W0517", "a shutter in a scene without time"},
};

}  // namespace fathom::compiler
