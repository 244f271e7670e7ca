-- The options of the plugin.
local M = {}

local defaults = {
  -- The server's command line; nil: $APT_LSP, or apt-lsp on the search path.
  cmd = nil,
  -- Settings of the section `apt`, as the server knows them (dialect, machine, severity ...).
  settings = {},
  -- Files or folders whose folder is the root of a project.
  root_markers = { 'apt-lsp.toml', '.git' },
  -- Milliseconds to wait for the server to come up when a command is given.
  start_timeout = 5000,
  -- Whether the server starts by itself with the first APT buffer.
  autostart = true,
  -- Called with (client, bufnr) when the server serves a buffer.
  on_attach = nil,
}

M.options = vim.deepcopy(defaults)

function M.set(options)
  if options ~= nil and type(options) ~= 'table' then
    error('apt: setup() takes a table', 2)
  end
  M.options = vim.tbl_deep_extend('force', vim.deepcopy(defaults), options or {})
end

--- The command line of the server program, without the mode it is to run in.
function M.program()
  local cmd = M.options.cmd
  if type(cmd) == 'string' then
    return { cmd }
  elseif cmd then
    return vim.deepcopy(cmd)
  end
  local from_environment = vim.env.APT_LSP
  if from_environment and from_environment ~= '' then
    return { from_environment }
  end
  return { 'apt-lsp' }
end

--- The program with more arguments.
function M.command(...)
  local command = M.program()
  vim.list_extend(command, { ... })
  return command
end

return M
