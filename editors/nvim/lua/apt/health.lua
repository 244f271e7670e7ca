-- `:checkhealth apt`
local config = require('apt.config')

local M = {}

local health = vim.health or require('health')
local start = health.start or health.report_start
local ok = health.ok or health.report_ok
local warn = health.warn or health.report_warn
local err = health.error or health.report_error

function M.check()
  start('apt')
  local program = config.program()[1]
  if vim.fn.executable(program) == 0 then
    err(('%s cannot be run: put it on the search path, or name it in setup({ cmd = ... }) or $APT_LSP'):format(program))
  else
    local command = config.command('--version')
    local version = vim.fn.systemlist(command)
    if vim.v.shell_error == 0 then
      ok(('%s: %s'):format(vim.fn.exepath(program), version[1] or ''))
    else
      err(('%s ended with %d'):format(table.concat(command, ' '), vim.v.shell_error))
    end
  end
  local clients = require('apt.client').clients()
  if #clients > 0 then
    ok(('%d server(s) running'):format(#clients))
  else
    warn('no server is running; it starts with the first APT buffer')
  end
  local interface = vim.lsp.start and 'vim.lsp.start' or 'vim.lsp.start_client'
  ok('servers are started with ' .. interface)
end

return M
