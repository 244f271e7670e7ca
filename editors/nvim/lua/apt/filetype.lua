-- Which files are APT. Some endings belong to other languages too; there the first lines decide.
local M = {}

-- Endings that are ours whatever the file says.
local CERTAIN = { 'apt', 'ncl', 'aptsource' }
-- Endings shared with other languages (LaTeX classes, OpenCL ...).
local SHARED = { 'cl', 'cls', 'clsf', 'cla' }
-- Lines of a shared file that are looked at: CL files begin with remarks and a heading.
local LINES_READ = 60

-- Starts of lines, in upper case, that only APT and CL files have.
local MARKS = {
  '^%s*PARTNO', '^%s*TOOL PATH%s*/', '^%s*TLDATA%s*/', '^%s*MSYS%s*/', '^%s*GOTO%s*/', '^%s*FROM%s*/',
  '^%s*LOADTL%s*/', '^%s*MACHIN%s*/', '^%s*CUTTER%s*/', '^%s*FEDRAT%s*/', '^%s*MULTAX', '^%$%$%*', '^%$%$%->',
}

--- Whether lines look like an APT or CL file.
function M.looks_like_apt(lines)
  for _, line in ipairs(lines) do
    local upper = line:upper()
    for _, mark in ipairs(MARKS) do
      if upper:find(mark) then
        return true
      end
    end
  end
  return false
end

local function first_lines(bufnr)
  return vim.api.nvim_buf_get_lines(bufnr, 0, LINES_READ, false)
end

local function starts_with_partno(bufnr)
  local first = vim.api.nvim_buf_get_lines(bufnr, 0, 1, false)[1] or ''
  return first:upper():find('^PARTNO') ~= nil
end

function M.register()
  local group = vim.api.nvim_create_augroup('apt_filetype', {})
  local function on(patterns, decide)
    vim.api.nvim_create_autocmd({ 'BufRead', 'BufNewFile' }, {
      group = group,
      pattern = patterns,
      callback = function(event)
        if vim.bo[event.buf].filetype ~= 'apt' and decide(event.buf) then
          -- Not `setfiletype`, which yields to a built-in type of the same ending.
          vim.bo[event.buf].filetype = 'apt'
        end
      end,
    })
  end
  local function patterns(endings)
    local found = {}
    for _, ending in ipairs(endings) do
      table.insert(found, '*.' .. ending)
      table.insert(found, '*.' .. ending:upper())
    end
    return found
  end
  on(vim.list_extend(patterns(CERTAIN), { '*.ncl.[0-9]*' }), function() return true end)
  on(patterns(SHARED), function(bufnr) return M.looks_like_apt(first_lines(bufnr)) end)
  -- Any other file that has no type yet.
  on({ '*' }, function(bufnr) return vim.bo[bufnr].filetype == '' and starts_with_partno(bufnr) end)
end

return M
