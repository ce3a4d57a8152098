# SPDX-License-Identifier: GPL-3.0-or-later
# The manual page anticrackd.toml(5), made from anticrackd.toml: "## Section", "# text" and, below it, "#key = default".
function plain(text) { gsub(/\\/, "\\e", text); gsub(/-/, "\\-", text); sub(/^[.']/, "\\\\\\&&", text); return text }
function told(of) { if (of != "") print of; return "" }
BEGIN {
  print ".TH ANTICRACKD.TOML 5 \"\" \"anticrack " version "\""
  print ".SH NAME\nanticrackd.toml \\- configuration of anticrackd\n.SH DESCRIPTION"
}
/SPDX/ { next }
/^## / { print ".SH " toupper(plain(substr($0, 4))) }
/^# / { key = told(key); text = text (text == "" ? "" : "\n") plain(substr($0, 3)) }
/^#[a-z]/ {  # a second key below the same text
  print (text == "" ? ".TQ" : ".TP") "\n\\fB" plain(substr($0, 2)) "\\fR"
  if (text != "") { key = text; text = "" }
}
/^$/ { key = told(key); text = told(text) }
END { told(key); print ".SH SEE ALSO\n.BR anticrackd (8)" }
