-- The lines of the views, from the server's answers. Plain functions; `isn[i]` is the statement of line `i`.
local M = {}

-- Words whose operand is text: no slash follows them.
local TEXT_WORDS = { PARTNO = true, PPRINT = true, INSERT = true, REMARK = true, TITLES = true }

--- JSON null arrives as vim.NIL.
local function present(value)
  if value == nil or value == vim.NIL then
    return nil
  end
  return value
end

--- The shortest decimals that read back as the same double, always with a point.
local function full(value)
  if type(value) ~= 'number' then
    return tostring(value)
  end
  for precision = 1, 17 do
    local text = ('%.' .. precision .. 'g'):format(value)
    if tonumber(text) == value then
      -- No exponent where plain decimals do.
      if text:find('e') and math.abs(value) < 1e17 and math.abs(value) >= 1e-6 then
        text = ('%.' .. math.max(0, precision - 1 - math.floor(math.log10(math.abs(value)))) .. 'f'):format(value)
      end
      return text:find('[.e]') and text or text .. '.0'
    end
  end
  return ('%.17g'):format(value)
end

local function joined(values)
  return table.concat(vim.tbl_map(full, values), ',')
end

-- Code of the record that holds the circle of the points behind it.
local CIRCLE_RECORD = 3000

local function listing()
  local self = { lines = {}, isn = {} }
  function self.add(line, isn)
    table.insert(self.lines, line)
    self.isn[#self.lines] = present(isn)
  end
  return self
end

--- The APT CL text of one entry of `cl`, as `apt-lsp run --format cl` writes it.
function M.cl_lines(entry)
  local points = present(entry.points) or {}
  if #points > 0 then
    local verb = entry.type == 'from' and 'FROM' or 'GOTO'
    return vim.tbl_map(function(point) return verb .. '/' .. joined(point) end, points)
  end
  local words = present(entry.words) or {}
  local major = words[1]
  if type(major) == 'string' then
    local operands = vim.list_slice(words, 2)
    if #operands == 0 then
      return { major }
    end
    if TEXT_WORDS[major] then
      return { major .. ' ' .. table.concat(vim.tbl_map(tostring, operands), ' ') }
    end
    return { major .. '/' .. joined(operands) }
  end
  local code = present(entry.code) or {}
  if type(code) ~= 'table' then
    code = { code }
  end
  if #words > 0 and code[1] == CIRCLE_RECORD then
    return { 'CIRCLE/' .. joined(words) }
  end
  if entry.type == 'fini' then
    return { 'FINI' }
  end
  return { ('$$ %s %s'):format(entry.type, joined(vim.list_extend(vim.list_slice(code), words))) }
end

--- The CL file of a run.
function M.cl(result)
  local list = listing()
  for _, entry in ipairs(result.cl) do
    for _, line in ipairs(M.cl_lines(entry)) do
      list.add(line, entry.isn)
    end
  end
  return list
end

--- The control tape.
function M.tape(tape)
  local list = listing()
  for index, block in ipairs(tape.blocks) do
    list.add(block, (present(tape.origin) or {})[index])
  end
  return list
end

local function band(name, clearance)
  if not present(clearance) then
    return nil
  end
  return ('%s %.6f … %.6f in [%.6f, %.6f]'):format(
    name, clearance.min, clearance.max, -clearance.intol, clearance.outtol)
end

--- What one motion came to: the verdict, then one line per surface.
function M.motion_summary(motion)
  local least = present(motion.minimum) and (' (least %d)'):format(motion.minimum) or ''
  local vectors = ('%d cut vector%s%s'):format(motion.cut_vectors, motion.cut_vectors == 1 and '' or 's', least)
  local lines = { ('%s, %s'):format(motion.verified and 'verified' or 'NOT VERIFIED', vectors) }
  for _, name in ipairs({ 'part', 'drive', 'check' }) do
    table.insert(lines, band(('%-5s'):format(name), motion[name]))
  end
  return lines
end

--- How much of a run is proven.
local function verdict(result)
  local verified = #vim.tbl_filter(function(motion) return motion.verified end, result.motions)
  local proof = ('%d of %d motions verified'):format(verified, #result.motions)
  return result.ok and proof or 'errors in the program; ' .. proof
end

--- The report of a run: verdict, findings, motions with their proof, CL points.
function M.motion(result)
  local list = listing()
  list.add(('%s: %s'):format(result.program, verdict(result)))
  if #result.diagnostics > 0 then
    list.add('')
    list.add('Findings')
    for _, finding in ipairs(result.diagnostics) do
      local place = present(finding.isn) and (' in statement %d'):format(finding.isn) or ''
      list.add(('  %s %s%s: %s'):format(finding.severity, finding.code, place, finding.message:gsub('\n', ' ')), finding.isn)
    end
  end
  list.add('')
  list.add('Motions')
  for _, motion in ipairs(result.motions) do
    list.add(('%6d  %s'):format(motion.isn, (motion.statement:gsub('\n', ' '))), motion.isn)
    for _, line in ipairs(M.motion_summary(motion)) do
      list.add('        ' .. line, motion.isn)
    end
  end
  list.add('')
  list.add('CL points')
  for _, entry in ipairs(result.cl) do
    for _, point in ipairs(present(entry.points) or {}) do
      local numbers = table.concat(vim.tbl_map(function(value) return ('%13.6f'):format(value) end, point))
      list.add(('%6d  %-8s%s'):format(entry.isn, present(entry.surface) or entry.type, numbers), entry.isn)
    end
  end
  return list
end

--- The canonical form of a surface.
function M.canonical(form)
  local list = listing()
  list.add(('%s = %s'):format(form.name, form.type))
  for _, line in ipairs(vim.split(form.text, '\n')) do
    list.add(line)
  end
  for _, value in ipairs(present(form.canonical) or {}) do
    list.add('  ' .. full(value))
  end
  return list
end

--- The lines that a program's statements stand on, from 1, by statement number, as an expansion tells them.
function M.statement_lines(expansion)
  local found = {}
  for _, origin in ipairs(expansion.origins) do
    found[origin.isn] = origin.range.start.line + 1
  end
  return found
end

--- The source line of each line of a list, from 1.
function M.origins(list, statement_lines)
  local found = {}
  for line, isn in pairs(list.isn) do
    found[line] = statement_lines[isn]
  end
  return found
end

return M
