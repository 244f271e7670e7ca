-- Windows that show what the server makes of a program. Each line knows the source line it comes from.
local M = {}

-- Per view buffer: { source = bufnr, lines = { [view line] = source line } }, lines from 1.
local views = {}

local function find_buffer(name)
  for _, bufnr in ipairs(vim.api.nvim_list_bufs()) do
    if vim.api.nvim_buf_get_name(bufnr) == name then
      return bufnr
    end
  end
end

local function show(bufnr)
  for _, window in ipairs(vim.api.nvim_tabpage_list_wins(0)) do
    if vim.api.nvim_win_get_buf(window) == bufnr then
      return window
    end
  end
  local before = vim.api.nvim_get_current_win()
  vim.cmd('belowright split')
  local window = vim.api.nvim_get_current_win()
  vim.api.nvim_win_set_buf(window, bufnr)
  vim.api.nvim_set_current_win(before)
  return window
end

--- Goes from a line of a view to the statement it comes from.
function M.jump()
  local view = views[vim.api.nvim_get_current_buf()]
  local line = view and view.lines[vim.api.nvim_win_get_cursor(0)[1]]
  if not line or not vim.api.nvim_buf_is_valid(view.source) then
    vim.notify('apt: this line comes from no statement', vim.log.levels.INFO)
    return
  end
  local window = vim.fn.bufwinid(view.source)
  if window == -1 then
    vim.cmd('sbuffer ' .. view.source)
  else
    vim.api.nvim_set_current_win(window)
  end
  vim.api.nvim_win_set_cursor(0, { line, 0 })
end

--- Shows lines in the view `kind` of a program; a view that is open already gets the new lines.
function M.open(source, kind, filetype, lines, origins)
  local stem = vim.fn.fnamemodify(vim.api.nvim_buf_get_name(source), ':t')
  local name = ('apt://%s/%s'):format(kind, stem ~= '' and stem or tostring(source))
  local bufnr = find_buffer(name)
  if not bufnr then
    bufnr = vim.api.nvim_create_buf(false, true)
    vim.api.nvim_buf_set_name(bufnr, name)
    vim.bo[bufnr].buftype = 'nofile'
    vim.bo[bufnr].bufhidden = 'hide'
    vim.bo[bufnr].swapfile = false
    for _, key in ipairs({ '<CR>', 'gd' }) do
      vim.keymap.set('n', key, M.jump, { buffer = bufnr, desc = 'APT: go to the statement' })
    end
    vim.keymap.set('n', 'q', '<cmd>close<cr>', { buffer = bufnr, desc = 'APT: close the view' })
    if filetype then
      vim.bo[bufnr].filetype = filetype
    end
  end
  views[bufnr] = { source = source, lines = origins or {} }
  vim.bo[bufnr].modifiable = true
  vim.api.nvim_buf_set_lines(bufnr, 0, -1, false, lines)
  vim.bo[bufnr].modifiable = false
  vim.bo[bufnr].modified = false
  show(bufnr)
  return bufnr
end

return M
