-- The server: one client per project folder, with whichever interface this Neovim has.
local config = require('apt.config')

local M = {}

local NAME = 'apt-lsp'

-- Neovim 0.7 has no reuse of clients: the running one of each folder.
local by_root = {}

local function root_of(path)
  local folder = path ~= '' and vim.fn.fnamemodify(path, ':p:h') or vim.fn.getcwd()
  local at = folder
  while true do
    for _, marker in ipairs(config.options.root_markers) do
      if vim.loop.fs_stat(at .. '/' .. marker) then
        return at
      end
    end
    local parent = vim.fn.fnamemodify(at, ':h')
    if parent == at then
      return folder
    end
    at = parent
  end
end

--- All running clients of this plugin.
function M.clients()
  local all = vim.lsp.get_clients or vim.lsp.get_active_clients
  return vim.tbl_filter(function(client) return client.name == NAME end, all())
end

--- The client that serves a buffer, or nil.
function M.of_buffer(bufnr)
  for _, client in ipairs(M.clients()) do
    if vim.lsp.buf_is_attached(bufnr, client.id) then
      return client
    end
  end
end

--- Starts the server for a buffer, unless one of its folder runs already.
function M.start(bufnr)
  local command = config.command('--stdio')
  if vim.fn.executable(command[1]) == 0 then
    vim.notify_once(('apt: the server %s cannot be run (:checkhealth apt)'):format(command[1]), vim.log.levels.ERROR)
    return nil
  end
  local root = root_of(vim.api.nvim_buf_get_name(bufnr))
  local options = {
    name = NAME,
    cmd = command,
    root_dir = root,
    settings = { apt = config.options.settings },
    init_options = config.options.settings,
    on_attach = config.options.on_attach,
    flags = { debounce_text_changes = 50 },
  }
  if vim.tbl_isempty(config.options.settings) then
    -- An empty Lua table would travel as a list.
    options.settings = { apt = vim.empty_dict() }
    options.init_options = vim.empty_dict()
  end
  if vim.lsp.start then
    return vim.lsp.start(options, { bufnr = bufnr })
  end
  options.on_exit = function() by_root[root] = nil end
  by_root[root] = by_root[root] or vim.lsp.start_client(options)
  if by_root[root] then
    vim.lsp.buf_attach_client(bufnr, by_root[root])
  end
  return by_root[root]
end

--- The client of a buffer, started and waited for when needed; nil and a message when there is none.
function M.ready(bufnr)
  local function initialized()
    local client = M.of_buffer(bufnr)
    return client and client.initialized and client or nil
  end
  if not initialized() then
    if not M.of_buffer(bufnr) and not M.start(bufnr) then
      return nil, 'the server cannot be started'
    end
    vim.wait(config.options.start_timeout, function() return initialized() ~= nil end, 20)
  end
  local client = initialized()
  if not client then
    return nil, 'the server does not answer'
  end
  return client
end

--- Sends a command of the server; `done(err, result)` is called later, on the main loop.
function M.execute(bufnr, command, argument, done)
  local client, problem = M.ready(bufnr)
  if not client then
    done(problem)
    return
  end
  local parameters = { command = command, arguments = { argument } }
  local function answer(err, result)
    done(err and (err.message or tostring(err)) or nil, result)
  end
  if vim.fn.has('nvim-0.11') == 1 then
    client:request('workspace/executeCommand', parameters, answer, bufnr)
  else
    client.request('workspace/executeCommand', parameters, answer, bufnr)
  end
end

--- Stops the servers and starts one for each loaded APT buffer.
function M.restart()
  local running = M.clients()
  for _, client in ipairs(running) do
    if vim.fn.has('nvim-0.11') == 1 then
      client:stop()
    else
      client.stop()
    end
  end
  vim.wait(config.options.start_timeout, function() return #M.clients() == 0 end, 20)
  by_root = {}
  for _, bufnr in ipairs(vim.api.nvim_list_bufs()) do
    if vim.api.nvim_buf_is_loaded(bufnr) and M.wanted(bufnr) then
      M.start(bufnr)
    end
  end
end

--- Whether a buffer is an APT program of the user (and not a view of this plugin).
function M.wanted(bufnr)
  return vim.bo[bufnr].filetype == 'apt' and vim.bo[bufnr].buftype == ''
end

function M.register()
  vim.api.nvim_create_autocmd('FileType', {
    group = vim.api.nvim_create_augroup('apt_client', {}),
    pattern = 'apt',
    callback = function(event)
      if config.options.autostart and M.wanted(event.buf) then
        M.start(event.buf)
      end
    end,
  })
end

return M
