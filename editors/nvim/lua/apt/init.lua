-- APT (Automatically Programmed Tools): what users call. See |apt.txt|.
local M = {}

--- Overrides options; see |apt-options|. Calling it is not needed.
function M.setup(options)
  require('apt.config').set(options)
end

return M
