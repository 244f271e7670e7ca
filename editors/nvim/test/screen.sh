#!/usr/bin/env bash
# What a person sees in Neovim, as the text of a terminal: a mistake, a hover, an expansion, a motion's CL points.
# Started by `cargo xtask test-nvim` with NVIM, APT_LSP, APT_TEST_FOLDER and APT_TEST_HOME.
set -euo pipefail
plugin=$(dirname "$APT_TEST_FOLDER")
parts=$(dirname "$plugin")/parts
home=$APT_TEST_HOME/screen
mkdir -p "$home"
cp "$parts"/*.apt "$home"
# The name of a socket has a limit of about a hundred characters: not below the repository.
sockets=$(mktemp -d)
screen() { tmux -S "$sockets/tmux" -f /dev/null "$@"; }
finish() { screen kill-server 2>/dev/null || true; rm -rf "$sockets"; }
trap finish EXIT

passed=0 failed=0
# Waits until the screen shows a line that fits; only a hang lets the waiting end without it.
sees() {
  for _ in $(seq 300); do
    if screen capture-pane -p -t nvim | grep -Eq -- "$2"; then
      passed=$((passed + 1))
      echo "ok   on the screen: $1"
      return 0
    fi
    sleep 0.1
  done
  failed=$((failed + 1))
  echo "FAIL on the screen: $1 ($2)"
  screen capture-pane -p -t nvim
}
types() { screen send-keys -t nvim "$@"; }

screen new-session -d -x 110 -y 40 -s nvim \
  "'$NVIM' --clean -n -i NONE --cmd 'set runtimepath^=$plugin' -c 'lua vim.diagnostic.config({ virtual_text = true })' '$home/mistake.apt'"
sees 'a mistake behind its statement' 'C1=CIRCLE/CENTER,P9,RADIUS,2 .*P9'
types ":edit $home/bracket.apt" Enter
sees 'the program' 'CALL/HOLE,X=6,Y=1'
types ":call search('GORGT/\\zsC1')" Enter
types ':lua vim.lsp.buf.hover()' Enter
sees 'a hover' '[Rr]adius 2'
types Escape ':AptExpand' Enter
sees 'an expansion' 'apt://expansion/bracket.apt'
types ':wincmd j | normal! G' Enter
sees 'its last lines' '^GOTO */ *9, *9, *1'
types ':close' Enter ':AptRun' Enter
sees 'the report of the motion' 'bracket.apt: ([1-9][0-9]*) of \1 motions verified'
types ':wincmd j | normal! Gzb' Enter
sees 'the last CL point' '9\.000000 +9\.000000 +1\.000000'
types ':qall!' Enter
echo "on the screen: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
