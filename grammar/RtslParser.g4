/*
 * The syntax of RTSL.
 *
 * RTSL is GLSL 4.60 without the rasteriser, with classes. This file is the one definition of the
 * syntax; the semantics (types, what may be written where) are checked later, and messages are
 * better if the syntax accepts a little more than the language: qualifiers, for example, are
 * accepted before any declaration.
 *
 * Every decision but one (is a statement that begins with a name a declaration?) needs one token of
 * lookahead, and that one mostly two: parsing is fast, and mistakes are detected where they are.
 *
 * Before the parser gets the tokens, frontend/syntax/TokenCheck.cpp has balanced the brackets and
 * rejected what is nested too deep, so that recursive rules cannot overflow the stack.
 */
parser grammar RtslParser;

options { tokenVocab = RtslLexer; }

// --- A file --------------------------------------------------------------------------------------

translationUnit
    : fileItem* EOF
    ;

fileItem
    : importDeclaration
    | structDeclaration
    | classDeclaration
    | declaration           // a function, or constants; after `class Name : Base;` its members
    ;

// import std.cameras;      a module of the standard library
// import "glass.rtsl";     a file, beside the one that imports it
importDeclaration
    : IMPORT ( modulePath | STRING_LITERAL ) SEMICOLON
    ;

modulePath
    : IDENTIFIER ( DOT IDENTIFIER )*
    ;

structDeclaration
    : STRUCT IDENTIFIER LEFT_BRACE declaration* RIGHT_BRACE SEMICOLON
    ;

// class Sphere : rt_Primitive;        its members are the declarations up to the end of the file
// class Sphere : rt_Primitive { };    any number of them in a file
// class Noise { };                    a helper class, which derives from nothing; only in this form
// default class Plain : rt_Material;  methods of all rt_Material classes that do not define them;
//                                     those without a body say for which classes
classDeclaration
    : DEFAULT? CLASS IDENTIFIER ( COLON IDENTIFIER )?
      ( LEFT_BRACE declaration* RIGHT_BRACE )? SEMICOLON
    ;

// --- Declarations --------------------------------------------------------------------------------

// A function, or one or more variables: they begin alike, and differ after the name. This includes
// members of classes, fields of structs and constants of a file.
//
//     vec3 reflected(vec3 d, vec3 n) { return d - 2 * dot(d, n) * n; }
//     public float roughness = 0.2, sheen;
declaration
    : qualifier* typeName
      ( IDENTIFIER parameters functionBody
      | declarator ( COMMA declarator )* SEMICOLON )
    | SEMICOLON             // a stray one is harmless
    ;

qualifier
    : PUBLIC | PRIVATE | SCRATCH | CONST | OPTIONAL | IN | OUT | INOUT
    ;

// vec3, Sphere, float[3][2], and vec3[] for a buffer
typeName
    : IDENTIFIER dimension*
    ;

dimension
    : LEFT_BRACKET expr? RIGHT_BRACKET
    ;

// Dimensions may follow the name, too, and are then the outer ones: vec4[2] a[3] is vec4[3][2] a.
declarator
    : IDENTIFIER dimension* range? ( ASSIGN initializer )?
    ;

// The values that a member, or a parameter of a constructor, may have, as an interval: a round
// bracket excludes its bound.
//
//     public float roughness in [0, 1] = 0.2, radius in (0, inf);
range
    : IN ( LEFT_BRACKET | LEFT_PAREN ) expr COMMA expr ( RIGHT_BRACKET | RIGHT_PAREN )
    ;

initializer
    : expr
    | LEFT_BRACE ( initializer ( COMMA initializer )* COMMA? )? RIGHT_BRACE
    ;

parameters
    : LEFT_PAREN ( parameter ( COMMA parameter )* )? RIGHT_PAREN
    ;

parameter
    : qualifier* typeName ( IDENTIFIER dimension* range? ( ASSIGN initializer )? )?
    ;

functionBody
    : block
    | SEMICOLON             // a prototype
    ;

// --- Statements ----------------------------------------------------------------------------------

block
    : LEFT_BRACE statement* RIGHT_BRACE
    ;

statement
    : block
    | ifStatement
    | forStatement
    | whileStatement
    | doStatement
    | switchStatement
    | caseLabel
    | breakStatement
    | continueStatement
    | returnStatement
    | illuminanceStatement
    | simpleStatement
    ;

// A statement before a semicolon, also the first one of a `for`.
simpleStatement
    : localDeclaration
    | expressionStatement
    | emptyStatement
    ;

localDeclaration
    : qualifier* typeName declarator ( COMMA declarator )* SEMICOLON
    ;

expressionStatement
    : expression SEMICOLON
    ;

emptyStatement
    : SEMICOLON
    ;

// An `else` belongs to the nearest `if`.
ifStatement
    : IF condition statement ( ELSE statement )?
    ;

forStatement
    : FOR LEFT_PAREN simpleStatement expression? SEMICOLON expression? RIGHT_PAREN statement
    ;

whileStatement
    : WHILE condition statement
    ;

doStatement
    : DO statement WHILE condition SEMICOLON
    ;

condition
    : LEFT_PAREN expression RIGHT_PAREN
    ;

// Labels are between the statements, as in C.
switchStatement
    : SWITCH condition LEFT_BRACE statement* RIGHT_BRACE
    ;

caseLabel
    : ( CASE expression | DEFAULT ) COLON
    ;

breakStatement
    : BREAK SEMICOLON
    ;

continueStatement
    : CONTINUE SEMICOLON
    ;

returnStatement
    : RETURN expression? SEMICOLON
    ;

// illuminance (P, N, angle) statement: runs the statement for each light that reaches P.
illuminanceStatement
    : ILLUMINANCE LEFT_PAREN arguments RIGHT_PAREN statement
    ;

// --- Expressions ---------------------------------------------------------------------------------

expression
    : expr ( COMMA expr )*
    ;

// From the tightest operator to the loosest. All are left-associative but the last two, which share
// a level: a ? b : c = d is a ? b : (c = d).
//
// A call is an expression followed by parentheses: `max(a, b)`, `albedo.lookup()`, `vec3(1)`,
// `float[3](1, 2, 3)`, and brackets may be empty only there, as in `float[](1, 2)`. `Base::shade()`
// calls the definition of a base class.
expr
    : LEFT_PAREN expression RIGHT_PAREN                                            # paren
    | literal                                                                      # constant
    | IDENTIFIER ( COLON_COLON IDENTIFIER )?                                       # name
    | expr DOT IDENTIFIER                                                          # member
    | expr LEFT_BRACKET expression? RIGHT_BRACKET                                  # index
    | expr LEFT_PAREN arguments RIGHT_PAREN                                        # call
    | expr op = ( PLUS_PLUS | MINUS_MINUS )                                        # postfix
    | op = ( PLUS_PLUS | MINUS_MINUS | PLUS | MINUS | NOT | TILDE ) expr           # prefix
    | expr op = ( STAR | SLASH | PERCENT ) expr                                    # binary
    | expr op = ( PLUS | MINUS ) expr                                              # binary
    | expr op = ( LEFT_SHIFT | RIGHT_SHIFT ) expr                                  # binary
    | expr op = ( LESS | GREATER | LESS_EQUAL | GREATER_EQUAL ) expr               # binary
    | expr op = ( EQUAL_EQUAL | NOT_EQUAL ) expr                                   # binary
    | expr op = AMPERSAND expr                                                     # binary
    | expr op = CARET expr                                                         # binary
    | expr op = BAR expr                                                           # binary
    | expr op = AND_AND expr                                                       # binary
    | expr op = XOR_XOR expr                                                       # binary
    | expr op = OR_OR expr                                                         # binary
    | <assoc = right> expr ( QUESTION expression COLON | assignment ) expr # conditionalOrAssignment
    ;

assignment
    : ASSIGN | PLUS_ASSIGN | MINUS_ASSIGN | STAR_ASSIGN | SLASH_ASSIGN | PERCENT_ASSIGN
    | LEFT_SHIFT_ASSIGN | RIGHT_SHIFT_ASSIGN | AND_ASSIGN | XOR_ASSIGN | OR_ASSIGN
    ;

arguments
    : ( expr ( COMMA expr )* )?
    ;

literal
    : INT_LITERAL
    | FLOAT_LITERAL
    | STRING_LITERAL
    | TRUE
    | FALSE
    ;
