/*
 * The tokens of RTSL.
 *
 * The lexer reads bytes, not Unicode characters: only comments and strings may contain anything but
 * ASCII, and so a token's start and end are offsets into the file. It never fails: invalid input
 * becomes one of the tokens under "Mistakes" at the end, which frontend/lex/Tokenizer.cpp reports
 * and keeps from the parser.
 *
 * Names of types (`float`, `vec3`, `color`, `rt_Material`) and of built-in functions are ordinary
 * identifiers. Only the keywords below cannot be names.
 */
lexer grammar RtslLexer;

tokens {
    // `illuminance` before `(` at the beginning of a statement; elsewhere it is an ordinary
    // identifier (distinguished in frontend/syntax/TokenCheck.cpp).
    ILLUMINANCE
}

// --- Keywords ------------------------------------------------------------------------------------

IMPORT   : 'import' ;
CLASS    : 'class' ;
STRUCT   : 'struct' ;

// Access to members.
PUBLIC   : 'public' ;     // set by the scene
PRIVATE  : 'private' ;    // set by the constructor
SCRATCH  : 'scratch' ;    // of one ray
CONST    : 'const' ;
OPTIONAL : 'optional' ;   // a reference that may be empty

// Direction of parameters.
IN       : 'in' ;
OUT      : 'out' ;
INOUT    : 'inout' ;

IF       : 'if' ;
ELSE     : 'else' ;
FOR      : 'for' ;
WHILE    : 'while' ;
DO       : 'do' ;
SWITCH   : 'switch' ;
CASE     : 'case' ;
DEFAULT  : 'default' ;
BREAK    : 'break' ;
CONTINUE : 'continue' ;
RETURN   : 'return' ;

TRUE     : 'true' ;
FALSE    : 'false' ;

// --- Literals ------------------------------------------------------------------------------------

// 42, 052, 0x2A, each with an optional u.
INT_LITERAL
    : ( [1-9] DIGIT* | '0' [0-7]* | '0' [xX] [0-9a-fA-F]+ ) [uU]?
    ;

// 1.5, 1., .5, 1e5, 1.5e-3, each with an optional f or lf.
FLOAT_LITERAL
    : ( DIGIT+ '.' DIGIT* EXPONENT? | '.' DIGIT+ EXPONENT? | DIGIT+ EXPONENT )
      ( [fF] | 'lf' | 'LF' )?
    ;

// "hit at %f\n"; only print takes strings. The escapes are \n \t \" \\.
STRING_LITERAL
    : '"' ( ~["\\\r\n] | '\\' ~[\r\n] )* '"'
    ;

IDENTIFIER
    : [a-zA-Z_] [a-zA-Z_0-9]*
    ;

fragment DIGIT    : [0-9] ;
fragment EXPONENT : [eE] [+-]? DIGIT+ ;

// --- Brackets and separators ---------------------------------------------------------------------

LEFT_PAREN    : '(' ;
RIGHT_PAREN   : ')' ;
LEFT_BRACKET  : '[' ;
RIGHT_BRACKET : ']' ;
LEFT_BRACE    : '{' ;
RIGHT_BRACE   : '}' ;
SEMICOLON     : ';' ;
COMMA         : ',' ;
COLON         : ':' ;
COLON_COLON   : '::' ;
QUESTION      : '?' ;
DOT           : '.' ;

// --- Operators -----------------------------------------------------------------------------------

PLUS_PLUS     : '++' ;
MINUS_MINUS   : '--' ;
NOT           : '!' ;
TILDE         : '~' ;
STAR          : '*' ;
SLASH         : '/' ;
PERCENT       : '%' ;
PLUS          : '+' ;
MINUS         : '-' ;
LEFT_SHIFT    : '<<' ;
RIGHT_SHIFT   : '>>' ;
LESS          : '<' ;
GREATER       : '>' ;
LESS_EQUAL    : '<=' ;
GREATER_EQUAL : '>=' ;
EQUAL_EQUAL   : '==' ;
NOT_EQUAL     : '!=' ;
AMPERSAND     : '&' ;
CARET         : '^' ;
BAR           : '|' ;
AND_AND       : '&&' ;
XOR_XOR       : '^^' ;
OR_OR         : '||' ;

ASSIGN             : '=' ;
PLUS_ASSIGN        : '+=' ;
MINUS_ASSIGN       : '-=' ;
STAR_ASSIGN        : '*=' ;
SLASH_ASSIGN       : '/=' ;
PERCENT_ASSIGN     : '%=' ;
LEFT_SHIFT_ASSIGN  : '<<=' ;
RIGHT_SHIFT_ASSIGN : '>>=' ;
AND_ASSIGN         : '&=' ;
XOR_ASSIGN         : '^=' ;
OR_ASSIGN          : '|=' ;

// --- Between the tokens --------------------------------------------------------------------------

WHITESPACE
    : [ \t\r\n\f\u000B]+ -> skip
    ;

// Comments are not skipped: those above declarations and statements are kept in the syntax tree.
LINE_COMMENT
    : '//' ~[\n]* -> channel(HIDDEN)
    ;

BLOCK_COMMENT
    : '/*' COMMENT_TEXT '*'+ '/' -> channel(HIDDEN)
    ;

fragment COMMENT_TEXT : ( ~'*' | '*'+ ~[*/] )* ;

// --- Mistakes ------------------------------------------------------------------------------------
// The longest match wins, and of equally long ones that of the first rule: these rules match what
// no rule above does.

UNTERMINATED_COMMENT
    : '/*' COMMENT_TEXT '*'*
    ;

UNTERMINATED_STRING
    : '"' ( ~["\\\r\n] | '\\' ~[\r\n] )* '\\'?
    ;

// 0x, 09, 1.5.2, 12abc, 1e+
MALFORMED_NUMBER
    : '.'? DIGIT ( [a-zA-Z_0-9.] | [eE] [+-] )*
    ;

// A directive that the preprocessor has left, to the end of its line (a backslash joins lines)
DIRECTIVE
    : '#' ( ~[\\\n] | '\\' '\r'? '\n' | '\\' )*
    ;

// Bytes of one or more characters that are not ASCII.
UNKNOWN_CHARACTERS
    : [\u0080-\u00FF]+
    ;

UNKNOWN_CHARACTER
    : .
    ;
