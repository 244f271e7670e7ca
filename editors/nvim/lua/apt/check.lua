-- `:AptCheck`: the command line's findings in the quickfix list.
local config = require('apt.config')

local M = {}

local TYPES = { error = 'E', warning = 'W', information = 'I', hint = 'N' }

--- The quickfix items of the check's JSON.
function M.items(report)
  local items = {}
  for _, file in ipairs(report.files) do
    for _, finding in ipairs(file.diagnostics) do
      local range = finding.range
      local located = type(range) == 'table'
      local hint = type(finding.hint) == 'string' and (' (' .. finding.hint .. ')') or ''
      table.insert(items, {
        filename = type(finding.file) == 'string' and finding.file or file.file,
        lnum = located and range.start.line + 1 or 1,
        col = located and range.start.character + 1 or 1,
        end_lnum = located and range['end'].line + 1 or nil,
        end_col = located and range['end'].character + 1 or nil,
        type = TYPES[finding.severity] or 'E',
        text = ('%s %s%s'):format(finding.code, finding.message, hint):gsub('\n', ' '),
      })
    end
  end
  return items
end

local function decode(text)
  if vim.json then
    return pcall(vim.json.decode, text)
  end
  return pcall(vim.fn.json_decode, text)
end

--- Checks files and folders; `done(err, items)` is called when the list is filled.
function M.run(paths, done)
  local command = config.command('--check')
  vim.list_extend(command, paths)
  vim.list_extend(command, { '--format', 'json' })
  local out, problems = {}, {}
  local job = vim.fn.jobstart(command, {
    stdout_buffered = true,
    stderr_buffered = true,
    on_stdout = function(_, data) out = data end,
    on_stderr = function(_, data) problems = data end,
    on_exit = function(_, status)
      -- 0: no findings, 1: findings, anything else: no check was made.
      local ok, report = decode(table.concat(out, '\n'))
      if status > 1 or not ok then
        done(('apt-lsp ended with %d: %s'):format(status, table.concat(problems, '\n')))
        return
      end
      local items = M.items(report)
      vim.fn.setqflist({}, ' ', { title = table.concat(command, ' '), items = items })
      done(nil, items, report.summary)
    end,
  })
  if job <= 0 then
    done(('%s cannot be run'):format(command[1]))
  end
end

return M
