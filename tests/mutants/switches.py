"""Puts a mutant beside the whole code: an expression becomes `(mutant ? changed : whole)`, so that one build has many.

What cannot be told apart at run time (a constant of a type, two types of a sum) does not compile then, and is built
alone (tree.py).
"""
import os
import re

MUTANT = "TEXTPLANE_MUTANT"
ASSIGNMENT = re.compile(r"\s*[\w.\[\]()>-]+\s*[-+*/]?=(?!=)")
DECLARATION = re.compile(r"\s*(?:static )?((?:const )?(?!auto|return|else)[\w:]+(?:<[^;=]*>)?[*&]?) [\w]+ = $")
KEYWORD = re.compile(r"\b(for|if|while|switch)( constexpr)? ?$")


def is_assignment(text, at):
    """Whether `=` at this place assigns."""
    return text[at] == "=" and text[at + 1] != "=" and text[at - 1] not in "=!<>"


def ends_choice(text, at):
    """Whether what stands here is the = of an assignment or the : of a choice, neither of which is part of an operand."""
    return is_assignment(text, at) or (text[at] == ":" and ":" not in (text[at - 1], text[at + 1]))


def left_end(text, at, stops):
    """Where the expression around `at` begins."""
    depth = 0
    while at > 0:
        c = text[at - 1]
        if c in ")]}":
            if c == "}" and depth == 0:
                return at
            depth += 1
            closing = at if depth == 1 else closing
        elif c in "([{":
            if depth == 0:
                return at
            depth -= 1
            if depth == 0 and KEYWORD.search(text[max(0, at - 20):at - 1]):
                return closing
        elif depth == 0 and (c in stops or ("?" in stops and ends_choice(text, at - 1)) or text[max(0, at - 7):at] == "return "):
            return at
        at -= 1
    return 0


def right_end(text, at, stops):
    """Where the expression around `at` ends."""
    depth = 0
    while at < len(text):
        c = text[at]
        if c in "([{":
            depth += 1
        elif c in ")]}":
            if depth == 0:
                return at
            depth -= 1
        elif depth == 0 and (c in stops or ("?" in stops and c == ":" and ends_choice(text, at))):
            return at
        at += 1
    return len(text)


def switch(text, old, new, number):
    """(begin, end, what stands there instead) in `text`, or None if no expression is found."""
    start = text.index(old)
    head = len(os.path.commonprefix([old, new]))
    tail = min(len(os.path.commonprefix([old[::-1], new[::-1]])), len(old) - head, len(new) - head)
    first, last, changed = start + head, start + len(old) - tail, new[head:len(new) - tail]
    whole_statement = left_end(text, first, ";"), right_end(text, last, ";")
    comments = re.compile(r"(\s*//[^\n]*\n)*").match(text, whole_statement[0])
    whole_statement = (comments.end() if comments.end() <= first else whole_statement[0]), whole_statement[1]
    statement = text[whole_statement[0]:whole_statement[1]]
    returns = text[:whole_statement[0]].endswith("return ")
    if returns or (ASSIGNMENT.match(statement) and text[whole_statement[1]] == ";"):
        begin, end = whole_statement
    else:
        begin, end = left_end(text, first, ",;?"), right_end(text, last, ",;?")
        if re.fullmatch(r"std::\w+", text[begin:end]):
            begin, end = left_end(text, begin - 1, ",;?"), right_end(text, end + 1, ",;?")
    whole, other = text[begin:end], text[begin:first] + changed + text[last:end]
    if any(sign in whole for sign in ("//", "#", "\\", "{\n")) or not whole.strip() or not other.strip():
        return None
    condition, lines = f"{MUTANT}({number})", "\n" * whole.count("\n")
    whole, other = whole.replace("\n", " "), other.replace("\n", " ")
    if returns:
        return begin - len("return "), end + 1, f"{{ if {condition} return {other}; return {whole}; }}{lines}"
    if (begin, end) == whole_statement and ASSIGNMENT.match(whole):
        space = whole[:len(whole) - len(whole.lstrip())]
        return begin, end, f"{space}({condition} ? void({other.strip()}) : void({whole.strip()})){lines}"
    declared = DECLARATION.match(text[whole_statement[0]:begin].split("\n")[-1] + " ") or DECLARATION.match(
        text[whole_statement[0]:begin].split("\n")[-1])
    cast = f"static_cast<{declared[1]}>" if declared else ""
    return begin, end, f" ({condition} ? {cast}({other}) : {cast}({whole})){lines}"


def put(text, mutants):
    """The text with switches for [(number, old, new)], and {number: line} of those that are in it."""
    places, lines, taken = [], {}, []
    for number, old, new in mutants:
        place = switch(text, old, new, number)
        if place and all(place[1] <= begin or end <= place[0] for begin, end in taken):
            places.append(place)
            taken.append(place[:2])
            lines[number] = (text.count("\n", 0, place[0]) + 1, text.count("\n", 0, place[1]) + 1)
    for begin, end, instead in sorted(places, reverse=True):
        text = text[:begin] + instead + text[end:]
    return text, lines
