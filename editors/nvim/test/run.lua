-- The plugin in the real Neovim, with the real server. Started by `cargo xtask test-nvim`; ends with :cquit.
local passed, failed = 0, 0
local current = ''

local function say(text)
  io.stdout:write(text .. '\n')
end

local function check(what, ok, detail)
  if ok then
    passed = passed + 1
    say(('ok   %s: %s'):format(current, what))
  else
    failed = failed + 1
    say(('FAIL %s: %s%s'):format(current, what, detail and ('\n     ' .. tostring(detail)) or ''))
  end
  return ok
end

local WAIT = 20000

local function wait_for(what, probe)
  local found
  vim.wait(WAIT, function()
    found = probe()
    return found
  end, 20)
  check(what, found)
  return found
end

local folder = assert(vim.env.APT_TEST_FOLDER, 'APT_TEST_FOLDER is set by cargo xtask test-nvim')
local home = assert(vim.env.APT_TEST_HOME, 'APT_TEST_HOME is set by cargo xtask test-nvim')
local parts = vim.fn.fnamemodify(folder, ':h:h') .. '/parts'

local client = require('apt.client')

local function open(name)
  local copy = home .. '/' .. name
  if vim.fn.filereadable(copy) == 0 then
    vim.fn.writefile(vim.fn.readfile(parts .. '/' .. name), copy)
  end
  vim.cmd('edit ' .. vim.fn.fnameescape(copy))
  return vim.api.nvim_get_current_buf()
end

local function lines(bufnr)
  return vim.api.nvim_buf_get_lines(bufnr, 0, -1, false)
end

local function line_with(bufnr, text)
  for number, line in ipairs(lines(bufnr)) do
    if line:find(text, 1, true) then
      return number, line
    end
  end
  return nil
end

local function errors(bufnr)
  return vim.diagnostic.get(bufnr, { severity = vim.diagnostic.severity.ERROR })
end

local function view(kind)
  for _, bufnr in ipairs(vim.api.nvim_list_bufs()) do
    if vim.startswith(vim.api.nvim_buf_get_name(bufnr), 'apt://' .. kind .. '/') then
      return bufnr
    end
  end
end

local function request(bufnr, method, parameters)
  local served = client.of_buffer(bufnr)
  local answer, problem
  if vim.fn.has('nvim-0.11') == 1 then
    answer, problem = served:request_sync(method, parameters, WAIT, bufnr)
  else
    answer, problem = served.request_sync(method, parameters, WAIT, bufnr)
  end
  return answer and answer.result, problem
end

local tests = {}

function tests.filetype()
  check('by ending', vim.bo[open('bracket.apt')].filetype == 'apt')
  for name, text in pairs({
    ['part'] = 'PARTNO X', ['path.ncl'] = 'GOTO/1,2,3', ['path.ncl.1'] = '$$* file', ['a.aptsource'] = 'X=1',
    ['tool.cls'] = 'TOOL PATH/A,TOOL,B', ['list.cl'] = 'FROM / 1.0, 2.0, 3.0',
  }) do
    vim.fn.writefile({ text }, home .. '/' .. name)
    vim.cmd('edit ' .. home .. '/' .. name)
    check(name, vim.bo.filetype == 'apt', vim.bo.filetype)
  end
  vim.fn.writefile({ '\\NeedsTeXFormat{LaTeX2e}' }, home .. '/article.cls')
  vim.cmd('edit ' .. home .. '/article.cls')
  check('a LaTeX class is left alone', vim.bo.filetype ~= 'apt', vim.bo.filetype)
end

function tests.syntax()
  vim.cmd('syntax on')
  local bufnr = open('bracket.apt')
  local function group(text, of)
    local number, line = line_with(bufnr, text)
    local column = line:find(of, 1, true)
    return vim.fn.synIDattr(vim.fn.synID(number, column, 1), 'name')
  end
  for _, case in ipairs({
    { 'PARTNO', 'PARTNO', 'aptText' }, { 'PARTNO', 'TEST', 'aptTextLine' }, { '$$ a macro', 'macro', 'aptComment' },
    { 'GORGT/C1', 'GORGT', 'aptMotion' }, { 'GORGT/C1', 'TLRGT', 'aptToolPosition' }, { 'C1=CIRCLE', 'C1', 'aptDefinition' },
    { 'C1=CIRCLE', 'CIRCLE', 'aptGeometricType' }, { 'HOLE=MACRO', 'HOLE', 'aptMacro' }, { 'CALL/HOLE', 'HOLE', 'aptCalled' },
    { 'AGAIN)I', 'AGAIN', 'aptLabel' }, { 'SPINDL', 'SPINDL', 'aptPostprocessor' }, { 'SPINDL', 'CLW', 'aptMinor' },
    { 'INTOL', '.0005', 'aptNumber' }, { 'LOOPST', 'LOOPST', 'aptLogic' },
  }) do
    local found = group(case[1], case[2])
    check(('%s is %s'):format(case[2], case[3]), found == case[3], found)
  end
end

function tests.mistake()
  local bufnr = open('mistake.apt')
  wait_for('a client serves the buffer', function() return client.of_buffer(bufnr) end)
  wait_for('the mistake is shown', function() return #errors(bufnr) > 0 end)
  local found = errors(bufnr)[1] or {}
  check('in its line', found.lnum == 3, vim.inspect(found))
  check('by name', (found.message or ''):find('P9', 1, true) ~= nil, found.message)
  vim.api.nvim_buf_set_lines(bufnr, 3, 4, false, { 'C1=CIRCLE/CENTER,P1,RADIUS,2' })
  wait_for('and taken back when mended', function() return #errors(bufnr) == 0 end)
  vim.cmd('edit!')
end

function tests.hover()
  local bufnr = open('bracket.apt')
  wait_for('a client serves the buffer', function() return client.of_buffer(bufnr) end)
  local number, line = line_with(bufnr, 'GORGT/C1')
  local result = request(bufnr, 'textDocument/hover', {
    textDocument = { uri = vim.uri_from_bufnr(bufnr) },
    position = { line = number - 1, character = line:find('C1', 1, true) - 1 },
  })
  local text = vim.inspect(result)
  check('the canonical form', text:find('CIRCLE', 1, true) and text:find('radius 2', 1, true), text)
  check('no errors in the program', #errors(bufnr) == 0, vim.inspect(errors(bufnr)))
end

function tests.expansion()
  local bufnr = open('bracket.apt')
  vim.cmd('AptExpand')
  local shown = wait_for('the view', function() return view('expansion') end)
  if not shown then return end
  local body = line_with(bufnr, 'GOTO/X,Y,1')
  local calls = 0
  vim.api.nvim_set_current_win(vim.fn.bufwinid(shown))
  for number, line in ipairs(lines(shown)) do
    if line:find('GOTO') then
      vim.api.nvim_set_current_win(vim.fn.bufwinid(shown))
      vim.api.nvim_win_set_cursor(0, { number, 0 })
      require('apt.view').jump()
      if vim.api.nvim_win_get_cursor(0)[1] == body then
        calls = calls + 1
      end
    end
  end
  check('two lines come from the body of the macro', calls == 2, table.concat(lines(shown), '\n'))
  check('highlighted as APT', vim.bo[shown].filetype == 'apt')
  check('not served as a program', client.of_buffer(shown) == nil)
end

function tests.motion()
  local bufnr = open('bracket.apt')
  vim.cmd('AptRun')
  local shown = wait_for('the report', function() return view('motion') end)
  if not shown then return end
  local text = table.concat(lines(shown), '\n')
  local verified, all = text:match('(%d+) of (%d+) motions verified')
  check('all motions are verified', verified == all and tonumber(all) > 0, text)
  -- The tool centre ends on its circle round C1 at the height of L1, within the tolerance of the program.
  local expected = math.sqrt(2.25 ^ 2 - 0.5 ^ 2)
  local near = false
  for _, line in ipairs(lines(shown)) do
    local x, y, z = line:match('^%s*%d+%s+%S+%s+(%-?[%d.]+)%s+(%-?[%d.]+)%s+(%-?[%d.]+)')
    if x and math.abs(x - expected) < 0.0011 and math.abs(y - 0.5) < 0.0011 and tonumber(z) == 0 then
      near = true
    end
  end
  check('the CL points reach the check surface', near, text)
  local number = line_with(bufnr, 'GORGT/C1')
  vim.api.nvim_set_current_buf(bufnr)
  vim.cmd(number .. 'AptRun')
  check('a line can be run by itself', true)
  vim.lsp.commands['apt.runMotion']({ arguments = { { uri = vim.uri_from_bufnr(bufnr) } } }, {})
  wait_for('the code lens command shows the report', function() return line_with(view('motion'), 'CL points') end)
end

function tests.cl_and_tape()
  local bufnr = open('bracket.apt')
  vim.cmd('AptCl')
  local cl = wait_for('the CL file', function() return view('cl') end)
  check('with the first point', cl and line_with(cl, 'FROM/3.0,-2.0,0.0'), cl and table.concat(lines(cl), '\n'))
  local command = require('apt.config').command('run', vim.api.nvim_buf_get_name(bufnr), '--format', 'cl')
  local written = vim.fn.systemlist(table.concat(vim.tbl_map(vim.fn.shellescape, command), ' ') .. ' 2>/dev/null')
  check('the same as the command line writes', cl and vim.deep_equal(lines(cl), written), table.concat(written, '\n'))
  vim.api.nvim_set_current_win(vim.fn.bufwinid(bufnr))
  vim.cmd('AptTape linuxcnc-mill3')
  local tape = wait_for('the tape', function() return view('tape') end)
  local text = tape and table.concat(lines(tape), '\n') or ''
  check('with the spindle', text:find('M0?3'), text)
  check('with the last point', text:find('X9%.?0*%s?Y9'), text)
end

function tests.tree_and_canonical()
  local bufnr = open('bracket.apt')
  vim.cmd('AptTree')
  local tree = wait_for('the tree', function() return view('tree') end)
  check('names what it has', tree and line_with(tree, 'MACRO'))
  vim.api.nvim_set_current_win(vim.fn.bufwinid(bufnr))
  vim.api.nvim_win_set_cursor(0, { line_with(bufnr, 'C1=CIRCLE'), 0 })
  vim.cmd('AptCanonical')
  local form = wait_for('the canonical form', function() return view('canonical') end)
  check('of the surface', form and line_with(form, 'C1 = CIRCLE'))
end

function tests.check_command()
  local path = home .. '/mistake.apt'
  vim.fn.setqflist({}, 'r')
  vim.cmd('AptCheck ' .. vim.fn.fnameescape(path))
  wait_for('the quickfix list is filled', function() return #vim.fn.getqflist() > 0 end)
  local item = vim.fn.getqflist()[1] or {}
  check('at the place', item.lnum == 4 and item.col > 1, vim.inspect(item))
  check('with code and words', (item.text or ''):find('^APT%d%d%d%d .*P9'), item.text)
  check('as an error', item.type == 'E')
  check('in the file', vim.fn.bufname(item.bufnr):find('mistake.apt', 1, true))
  vim.cmd('cclose')
end

function tests.restart()
  local bufnr = open('bracket.apt')
  local before = client.of_buffer(bufnr)
  vim.cmd('AptRestart')
  wait_for('another client', function()
    local now = client.of_buffer(bufnr)
    return now and before and now.id ~= before.id
  end)
end

function tests.health()
  vim.cmd('checkhealth apt')
  local text = table.concat(lines(0), '\n')
  check('names the server', text:find('apt%-lsp'), text)
  check('has no errors', not text:find('ERROR', 1, true), text)
  vim.cmd('bwipeout!')
end

function tests.help()
  vim.cmd('helptags ' .. vim.fn.fnameescape(vim.fn.fnamemodify(folder, ':h') .. '/doc'))
  for _, tag in ipairs({ 'apt.txt', ':AptRun', ':AptExpand', ':AptTape', ':AptCheck', ':AptCl', ':AptTree', ':AptCanonical', ':AptRestart', 'apt-options' }) do
    check(tag, pcall(vim.cmd, 'help ' .. tag))
    vim.cmd('helpclose')
  end
end

local ORDER = {
  'filetype', 'syntax', 'mistake', 'hover', 'expansion', 'motion', 'cl_and_tape', 'tree_and_canonical', 'check_command',
  'restart', 'health', 'help',
}
for _, name in ipairs(ORDER) do
  current = name
  local ok, problem = xpcall(tests[name], debug.traceback)
  if not ok then
    check('runs to its end', false, problem)
  end
end
current = 'all'
check('no error message of the editor', vim.v.errmsg == '', vim.v.errmsg)
local version = vim.version()
say(('Neovim %d.%d.%d: %d passed, %d failed'):format(version.major, version.minor, version.patch, passed, failed))
vim.cmd('cquit ' .. (failed > 0 and 1 or 0))
