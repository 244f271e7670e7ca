-- The user commands.
local check = require('apt.check')
local client = require('apt.client')
local config = require('apt.config')
local report = require('apt.report')
local view = require('apt.view')

local M = {}

local function complain(message)
  vim.notify('apt: ' .. message, vim.log.levels.ERROR)
end

local function uri_of(bufnr)
  return vim.uri_from_bufnr(bufnr)
end

--- Asks the server and goes on with the result; says so when there is none.
local function ask(bufnr, command, argument, go_on)
  client.execute(bufnr, command, argument, function(err, result)
    if err then
      complain(err)
    elseif result == nil or result == vim.NIL then
      complain('nothing is known about this place')
    else
      -- An answer of an unexpected shape is a fault of the server: said in words, not as a stack of this plugin.
      local ok, problem = pcall(go_on, result)
      if not ok then
        complain(('the answer to %s cannot be shown: %s'):format(command, problem))
      end
    end
  end)
end

--- Shows a list of lines whose statements are found through the expansion.
local function show_list(bufnr, kind, filetype, list)
  ask(bufnr, 'apt.expand', { uri = uri_of(bufnr) }, function(expansion)
    view.open(bufnr, kind, filetype, list.lines, report.origins(list, report.statement_lines(expansion)))
  end)
end

--- The whole lines from `first` to `last` (from 1) as an LSP range.
local function lines_range(first, last)
  return { start = { line = first - 1, character = 0 }, ['end'] = { line = last, character = 0 } }
end

--- Runs motion of a program, or of a range of it, and shows the report.
function M.run_motion(bufnr, range)
  ask(bufnr, 'apt.runMotion', { uri = uri_of(bufnr), range = range }, function(result)
    show_list(bufnr, 'motion', nil, report.motion(result))
  end)
end

function M.cl(bufnr)
  ask(bufnr, 'apt.runMotion', { uri = uri_of(bufnr) }, function(result)
    show_list(bufnr, 'cl', 'apt', report.cl(result))
  end)
end

function M.expand(bufnr, position)
  ask(bufnr, 'apt.expand', { uri = uri_of(bufnr), position = position }, function(expansion)
    local lines = vim.split((expansion.text:gsub('\n$', '')), '\n')
    local origins = {}
    for _, origin in ipairs(expansion.origins) do
      origins[origin.line + 1] = origin.range.start.line + 1
    end
    view.open(bufnr, 'expansion', 'apt', lines, origins)
  end)
end

local function show_tape(bufnr, machine)
  ask(bufnr, 'apt.post', { uri = uri_of(bufnr), machine = machine }, function(tape)
    show_list(bufnr, 'tape', nil, report.tape(tape))
  end)
end

--- Shows the tape; without a machine in the command, the settings or the project file, one is chosen.
function M.tape(bufnr, machine)
  if not machine or machine == '' then
    machine = config.options.settings.machine
  end
  if machine then
    show_tape(bufnr, machine)
    return
  end
  client.execute(bufnr, 'apt.post', { uri = uri_of(bufnr) }, function(err, tape)
    if not err then
      show_list(bufnr, 'tape', nil, report.tape(tape))
      return
    end
    ask(bufnr, 'apt.machines', vim.empty_dict(), function(machines)
      local names = vim.tbl_map(function(known) return known.name end, machines)
      vim.ui.select(names, { prompt = 'Machine of the control tape:' }, function(choice)
        if choice then
          show_tape(bufnr, choice)
        end
      end)
    end)
  end)
end

function M.tree(bufnr)
  ask(bufnr, 'apt.syntaxTree', { uri = uri_of(bufnr) }, function(tree)
    view.open(bufnr, 'tree', nil, vim.split((tree.text:gsub('\n$', '')), '\n'))
  end)
end

function M.canonical(bufnr)
  local parameters = vim.lsp.util.make_position_params(0, (client.of_buffer(bufnr) or {}).offset_encoding)
  ask(bufnr, 'apt.canonicalForm', { uri = uri_of(bufnr), position = parameters.position }, function(form)
    view.open(bufnr, 'canonical', nil, report.canonical(form).lines)
  end)
end

function M.check(paths)
  check.run(paths, function(err, items, summary)
    if err then
      complain(err)
      return
    end
    vim.notify(('apt: %d errors, %d warnings'):format(summary.errors, summary.warnings), vim.log.levels.INFO)
    if #items > 0 then
      vim.cmd('copen')
    else
      vim.cmd('cclose')
    end
  end)
end

local machine_names = {}

--- Completion of machine names; filled by the first answer of a server.
local function complete_machine(lead)
  local bufnr = vim.api.nvim_get_current_buf()
  if #machine_names == 0 then
    local answered = false
    client.execute(bufnr, 'apt.machines', vim.empty_dict(), function(_, machines)
      for _, machine in ipairs(machines or {}) do
        table.insert(machine_names, machine.name)
      end
      answered = true
    end)
    vim.wait(config.options.start_timeout, function() return answered end, 10)
  end
  return vim.tbl_filter(function(name) return vim.startswith(name, lead) end, machine_names)
end

function M.register()
  local function define(name, action, options)
    vim.api.nvim_create_user_command(name, function(arguments)
      action(vim.api.nvim_get_current_buf(), arguments)
    end, options)
  end
  define('AptRun', function(bufnr, arguments)
    M.run_motion(bufnr, arguments.range > 0 and lines_range(arguments.line1, arguments.line2) or nil)
  end, { range = true, desc = 'Run motion of the program or of the given lines' })
  define('AptCl', function(bufnr) M.cl(bufnr) end, { desc = 'Show the CL file' })
  define('AptExpand', function(bufnr, arguments)
    M.expand(bufnr, arguments.range > 0 and { line = arguments.line1 - 1, character = 0 } or nil)
  end, { range = true, desc = 'Show the program, or the given line, with macros and loops unrolled' })
  define('AptTape', function(bufnr, arguments) M.tape(bufnr, arguments.args) end,
    { nargs = '?', complete = complete_machine, desc = 'Show the control tape' })
  define('AptTree', function(bufnr) M.tree(bufnr) end, { desc = 'Show the syntax tree' })
  define('AptCanonical', function(bufnr) M.canonical(bufnr) end, { desc = 'Show the canonical form at the cursor' })
  define('AptCheck', function(bufnr, arguments)
    local paths = arguments.fargs
    if #paths == 0 then
      paths = { vim.api.nvim_buf_get_name(bufnr) }
    end
    M.check(vim.tbl_map(vim.fn.expand, paths))
  end, { nargs = '*', complete = 'file', desc = 'Check files and folders into the quickfix list' })
  define('AptRestart', function() client.restart() end, { desc = 'Restart the server' })

  -- Code lenses of the server name this command; its result is for the user's eyes.
  vim.lsp.commands['apt.runMotion'] = function(command)
    local argument = (command.arguments or {})[1] or {}
    if not argument.uri then
      complain('the command apt.runMotion came without a program')
      return
    end
    M.run_motion(vim.uri_to_bufnr(argument.uri), argument.range)
  end
end

return M
