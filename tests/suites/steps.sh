# Sourced by scripts that run steps.

rows=() passed=0 failed=0

# step NAME COMMAND...: runs a command and notes its seconds. The steps after one that fails run, too. Exit status 77 says
# that this machine cannot run the step.
step() {
  local name=$1 begin=$SECONDS result=ok status=0
  shift
  printf '\n== %s: %s\n' "$name" "$*"
  "$@" </dev/null || status=$?
  case $status in
    0) passed=$((passed + 1)) ;;
    77) result="not run" ;;
    *) result=FAILED failed=$((failed + 1)) ;;
  esac
  rows+=("$(printf '%-32s %5d s  %s' "$name" $((SECONDS - begin)) "$result")")
}

# finish: prints the table of steps, and ends the script, with 1 if a step failed.
finish() {
  printf '\n'
  printf '%s\n' "${rows[@]}" "$(printf '%-32s %5d s' all "$SECONDS")"
  echo "$passed passed, $failed failed"
  exit $((failed > 0))
}
