# Makes a man page of the help of the program, then, each after a line `@command NAME`, of that of each command.
# In a help, two spaces begin an option, an argument or a command. Its text begins at column 31, or stands on the next line.

function roff(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  sub(/^[.']/, "\\\\\\&&", text)
  return text
}

# A tagged paragraph; the first word of the tag is what the user types.
function item(tag, text,    word) {
  word = tag
  sub(/ .*/, "", word)
  print ".TP\n\\fB" roff(word) "\\fR" roff(substr(tag, length(word) + 1))
  if (text != "") print roff(text)
}

# Prints the item that waits for the next line, which tells whether its text stands there.
function end_item(text) {
  if (waiting == "") return
  if (text != "") item(substr(waiting, 3), text)
  else {
    tag = substr(waiting, 3, 28)
    sub(/ *$/, "", tag)
    item(tag, substr(waiting, 31))
  }
  waiting = ""
}

BEGIN {
  printf ".TH SPRUNG 1 \"\" \"%s\" \"User Commands\"\n", version
}

/^          / && waiting != "" {
  sub(/^ +/, "")
  end_item($0)
  next
}

{
  end_item("")
}

/^@command / {
  if (command == "") print ".SH COMMANDS"
  command = $2
  print ".SS " command
  lines = 0
  part = ""
  next
}

++lines == 1 {
  summary = $0
  if (command != "") print roff(summary) "."
  next
}

/^Usage: / {
  sub(/^Usage: /, "")
  if (command == "") {
    sub(/\.$/, "", summary)
    print ".SH NAME\nsprung \\- " roff(tolower(substr(summary, 1, 1)) substr(summary, 2)) "\n.SH SYNOPSIS"
  } else {
    print ".PP"
  }
  print ".B " roff($0)
  next
}

/^[A-Z][^.]*:$/ {
  part = $0
  if (part == "Examples:") {
    footer = ".SH EXAMPLES\n.EX"
  } else if (part == "Options:" && command == "") {
    print ".SH OPTIONS"
  } else if (part != "Options:" && part != "Positionals:" && part != "Subcommands:") {
    print ".PP\n" roff(part)
  }
  next
}

# The footer, which each help repeats, ends the page: examples, notes, exit codes.
part == "Examples:" && /^  / {
  footer = footer "\n" roff(substr($0, 3))
  next
}

part == "Examples:" {
  part = "Footer:"
  footer = footer "\n.EE\n.SH NOTES"
  next
}

part == "Footer:" {
  if (sub(/^Exit codes: /, "")) footer = footer "\n.SH EXIT STATUS"
  if ($0 != "") footer = footer "\n" roff($0)
  next
}

part == "Subcommands:" {
  next # each has a section of its own
}

/^  [^ ]/ {
  waiting = $0
}

END {
  end_item("")
  print footer
}
