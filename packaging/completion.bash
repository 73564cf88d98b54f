# Completes the commands of Fresco's programs, their options and the values of these. It reads all of them from --help
# when Tab is pressed.
_fresco() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} word option choices
  local newline=$'\n' command=("${COMP_WORDS[0]}")
  local help=$("${command[@]}" --help 2>/dev/null)
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ $word == [a-z]* && $help == *"Subcommands:"*"$newline  $word "* ]]; then
      command+=("$word")
      help=$("${command[@]}" --help 2>/dev/null)
    fi
  done
  # --format=text is three words for bash.
  [[ $current == "=" ]] && current=""
  [[ $previous == "=" ]] && previous=${COMP_WORDS[COMP_CWORD - 2]}
  # The help of the option before the cursor, if it takes a value: its line and those that continue it, as one line.
  option=$(awk -v name="$previous" '/^  [^ ]/ || /^$/ { found = $1 == name && $2 ~ /^([A-Z_=]+|{.*})$/ } found' <<<"$help" | xargs -d '\n')
  if [[ $previous == --* && -n $option ]]; then
    if [[ $option =~ \{([^}]+)\} ]]; then
      choices=${BASH_REMATCH[1]//,/ }
    elif [[ $option =~ "name of a ready one ("([^\)]+)")" ]]; then
      choices=${BASH_REMATCH[1]//,/}
    fi  # otherwise bash completes the name of a file
  else
    choices=$(sed -nE '/^Subcommands:/,/^$/s/^  ([a-z]+) .*/\1/p; s/^  (-h,)?(--[a-z-]+).*/\2/p' <<<"$help")
  fi
  COMPREPLY=($(compgen -W "$choices" -- "$current"))
}
complete -o default -F _fresco fresco fresco-actor fresco-learner fresco-world
