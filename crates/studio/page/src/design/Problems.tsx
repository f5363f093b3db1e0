import type { Edit, Problem } from '../data/types';
import { Words } from '../parts/Markdown';

/** Problems of the rules or of a level: each with its place, its words and its fixes. */
export function Problems({ name, problems, onShow, onPage, onFix }: { name: string; problems: Problem[]; onShow: (problem: Problem) => void; onPage: (name: string) => void; onFix: (edits: Edit[]) => void }) {
  if (problems.length === 0) return null;
  return (
    <ul class="problems" aria-label={name}>
      {problems.map((problem) => (
        <li class={problem.severity}>
          <button type="button" class="link" onClick={() => onShow(problem)} aria-label={`Go to line ${problem.line}`}>{problem.line}</button>
          <ProblemWords problem={problem} onPage={onPage} />
          {problem.fixes.map((fix) => <button type="button" class="fix" onClick={() => onFix(fix.edits)}><Words text={fix.title} /></button>)}
        </li>
      ))}
    </ul>
  );
}

export function ProblemWords({ problem, onPage }: { problem: Problem; onPage: (name: string) => void }) {
  return (
    <div class="problem-words">
      <strong><Words text={problem.message} /></strong>
      {problem.label && problem.label !== problem.message && <span><Words text={problem.label} /></span>}
      {problem.help && <span class="soft"><Words text={problem.help} /></span>}
      {problem.page && <button type="button" class="link" onClick={() => onPage(problem.page ?? '')}>explain</button>}
    </div>
  );
}
